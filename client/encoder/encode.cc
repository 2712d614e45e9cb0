// How the order comes back.
//
// The sequential method keeps the order of points and faces. Edgebreaker does
// not, and says nothing about it. So the mesh is encoded a second time with an
// attribute that numbers the sites (places in space where vertices are). Both
// payloads decode to the same faces in the same order, though their points may
// be numbered apart; so the second, which is thrown away, tells the sites of
// each decoded face. That the positions agree, corner by corner, is checked;
// did they not, the payload with the numbers would be the one that is sent.
#include "client/encoder/encode.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/encoder/point_mesh.h"
#include "client/segmentation.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

using client::kNone;

// Draco counts corners in 32 bits, some of them signed.
constexpr size_t kMaxTriangles = size_t{1} << 29;

// `values` has N numbers a row; `index` gives a point its row.
template <typename T, size_t N>
int AddAttribute(draco::GeometryAttribute::Type type, draco::DataType data_type,
                 const std::vector<std::array<T, N>>& values,
                 const std::vector<uint32_t>& index, draco::Mesh* mesh) {
  draco::GeometryAttribute description;
  description.Init(type, nullptr, N, data_type, false, sizeof(T) * N, 0);
  const int id = mesh->AddAttribute(description, false,
                                    static_cast<uint32_t>(values.size()));
  draco::PointAttribute* attribute = mesh->attribute(id);
  for (uint32_t i = 0; i < values.size(); ++i) {
    attribute->SetAttributeValue(draco::AttributeValueIndex(i),
                                 values[i].data());
  }
  for (uint32_t p = 0; p < index.size(); ++p) {
    attribute->SetPointMapEntry(draco::PointIndex(p),
                                draco::AttributeValueIndex(index[p]));
  }
  return id;
}

void AddSiteNumbers(const PointMesh& points, draco::Mesh* mesh) {
  std::vector<std::array<uint32_t, 1>> numbers(points.sites.rows.size());
  for (uint32_t s = 0; s < numbers.size(); ++s) numbers[s] = {s};
  AddAttribute(draco::GeometryAttribute::GENERIC, draco::DT_UINT32, numbers,
               points.point_site, mesh);
}

void AddPositions(const PointMesh& points, bool narrow, draco::Mesh* mesh) {
  if (!narrow) {
    AddAttribute(draco::GeometryAttribute::POSITION, draco::DT_FLOAT64,
                 points.sites.rows, points.point_site, mesh);
    return;
  }
  std::vector<std::array<float, 3>> rows;
  rows.reserve(points.sites.rows.size());
  for (const auto& [x, y, z] : points.sites.rows) {
    rows.push_back({ToFloat(x), ToFloat(y), ToFloat(z)});
  }
  AddAttribute(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, rows,
               points.point_site, mesh);
}

// `narrow`: positions become floats.
std::unique_ptr<draco::Mesh> ToDraco(const PointMesh& points, bool narrow,
                                     bool number_sites) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<uint32_t>(points.point_site.size()));
  mesh->SetNumFaces(points.faces.size());
  for (uint32_t f = 0; f < points.faces.size(); ++f) {
    const Corners& c = points.faces[f];
    mesh->SetFace(draco::FaceIndex(f),
                  {draco::PointIndex(c[0]), draco::PointIndex(c[1]),
                   draco::PointIndex(c[2])});
  }
  AddPositions(points, narrow, mesh.get());
  if (!points.uvs.rows.empty()) {
    AddAttribute(draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32,
                 points.uvs.rows, points.point_uv, mesh.get());
  }
  if (!points.normals.rows.empty()) {
    AddAttribute(draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32,
                 points.normals.rows, points.point_normal, mesh.get());
  }
  if (number_sites) AddSiteNumbers(points, mesh.get());
  return mesh;
}

// Draco quantizes floats alone.
bool IsNarrow(const PointMesh& points, const EncodeOptions& options) {
  return options.quantization_bits > 0 || AreFloats(points.sites.rows);
}

absl::StatusOr<std::string> RunEncoder(const PointMesh& points,
                                       const EncodeOptions& options,
                                       EncodeMethod method, bool number_sites) {
  const std::unique_ptr<draco::Mesh> mesh =
      ToDraco(points, IsNarrow(points, options), number_sites);
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetSpeedOptions(options.speed, options.speed);
  encoder.SetEncodingMethod(method == EncodeMethod::kEdgebreaker
                                ? draco::MESH_EDGEBREAKER_ENCODING
                                : draco::MESH_SEQUENTIAL_ENCODING);
  if (options.quantization_bits > 0) {
    encoder.SetAttributeQuantization(
        mesh->GetNamedAttributeId(draco::GeometryAttribute::POSITION),
        options.quantization_bits);
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("Draco cannot encode the mesh (", status.error_msg(),
                     "); try the sequential method"));
  }
  return std::string(buffer.data(), buffer.size());
}

// What a payload decodes to, as far as the order goes.
struct Decoded {
  std::vector<Corners> faces;  // points
  // Bits, by point: of three doubles, or of three floats and zeros behind.
  std::vector<std::array<uint64_t, 3>> positions;
  std::vector<uint32_t> point_site;  // empty where sites are not numbered
};

absl::StatusOr<Decoded> RunDecoder(const std::string& bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("Draco cannot decode what it encoded (",
                     mesh.status().error_msg(), "); try another speed"));
  }
  Decoded decoded;
  const uint32_t num_points = mesh.value()->num_points();
  for (uint32_t f = 0; f < mesh.value()->num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.value()->face(draco::FaceIndex(f));
    decoded.faces.push_back(
        {face[0].value(), face[1].value(), face[2].value()});
  }
  decoded.positions.resize(num_points);
  const draco::PointAttribute* positions =
      mesh.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const draco::PointAttribute* numbers =
      mesh.value()->GetNamedAttribute(draco::GeometryAttribute::GENERIC);
  if (numbers != nullptr) decoded.point_site.resize(num_points);
  for (uint32_t p = 0; p < num_points; ++p) {
    const draco::PointIndex point(p);
    positions->GetMappedValue(point, &decoded.positions[p]);
    if (numbers != nullptr) {
      numbers->GetMappedValue(point, &decoded.point_site[p]);
    }
  }
  return decoded;
}

// Gives the points of `plain` the sites of those in the same corners of
// `numbered`. False where the two do not agree.
bool TransferSites(const Decoded& numbered, Decoded* plain) {
  if (numbered.faces.size() != plain->faces.size()) return false;
  plain->point_site.assign(plain->positions.size(), kNone);
  for (size_t f = 0; f < numbered.faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t theirs = numbered.faces[f][i];
      const uint32_t ours = plain->faces[f][i];
      const uint32_t site = numbered.point_site[theirs];
      uint32_t& known = plain->point_site[ours];
      if (numbered.positions[theirs] != plain->positions[ours] ||
          (known != kNone && known != site)) {
        return false;
      }
      known = site;
    }
  }
  return std::find(plain->point_site.begin(), plain->point_site.end(), kNone) ==
         plain->point_site.end();
}

// As Decoded has them, where nothing was quantized.
std::array<uint64_t, 3> PositionBits(const std::array<double, 3>& position,
                                     bool narrow) {
  std::array<uint64_t, 3> bits{};
  if (narrow) {
    const std::array<float, 3> floats{
        ToFloat(position[0]), ToFloat(position[1]), ToFloat(position[2])};
    std::memcpy(bits.data(), floats.data(), sizeof floats);
  } else {
    std::memcpy(bits.data(), position.data(), sizeof position);
  }
  return bits;
}

// Whether a payload decodes to the points and faces in their own order. Faces
// alone do not tell: those of a soup are 0 1 2, 3 4 5, ... in any order.
bool KeptTheirOrder(const PointMesh& points, const EncodeOptions& options,
                    const Decoded& decoded) {
  if (options.quantization_bits > 0 || decoded.faces != points.faces ||
      decoded.positions.size() != points.point_site.size())
    return false;
  const bool narrow = IsNarrow(points, options);
  for (size_t p = 0; p < decoded.positions.size(); ++p)
    if (decoded.positions[p] !=
        PositionBits(points.sites.rows[points.point_site[p]], narrow))
      return false;
  return true;
}

// A payload and the site of each point as it decodes.
struct OrderedPayload {
  std::string bytes;
  Decoded decoded;
};

absl::StatusOr<OrderedPayload> EncodeInOrder(const PointMesh& points,
                                             const EncodeOptions& options,
                                             EncodeMethod method) {
  OrderedPayload payload;
  MARROW_ASSIGN_OR_RETURN(payload.bytes,
                          RunEncoder(points, options, method, false));
  MARROW_ASSIGN_OR_RETURN(payload.decoded, RunDecoder(payload.bytes));
  if (KeptTheirOrder(points, options, payload.decoded)) {
    payload.decoded.point_site = points.point_site;
    return payload;
  }
  MARROW_ASSIGN_OR_RETURN(std::string numbered_bytes,
                          RunEncoder(points, options, method, true));
  MARROW_ASSIGN_OR_RETURN(Decoded numbered, RunDecoder(numbered_bytes));
  if (!TransferSites(numbered, &payload.decoded)) {
    payload.bytes = std::move(numbered_bytes);
    payload.decoded = std::move(numbered);
  }
  return payload;
}

// Begins with the least, turned the same way.
Corners Rotated(Corners c) {
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  return c;
}

using KeyedFaces = std::vector<std::pair<Corners, uint32_t>>;

KeyedFaces SortByKey(const std::vector<Corners>& site_corners) {
  KeyedFaces keyed;
  keyed.reserve(site_corners.size());
  for (uint32_t f = 0; f < site_corners.size(); ++f) {
    keyed.emplace_back(Rotated(site_corners[f]), f);
  }
  std::sort(keyed.begin(), keyed.end());
  return keyed;
}

// Decoded face -> triangle, by the sites of the corners; of equal ones each is
// taken once, in order. Nothing where a decoded face has no triangle left.
std::optional<std::vector<uint32_t>> MatchFaces(const PointMesh& points,
                                                const Decoded& decoded) {
  std::vector<Corners> decoded_sites;
  decoded_sites.reserve(decoded.faces.size());
  for (const Corners& face : decoded.faces) {
    decoded_sites.push_back({decoded.point_site[face[0]],
                             decoded.point_site[face[1]],
                             decoded.point_site[face[2]]});
  }
  const KeyedFaces ours = SortByKey(points.site_corners);
  std::vector<uint32_t> triangles(decoded.faces.size());
  size_t next = 0;
  for (const auto& [key, face] : SortByKey(decoded_sites)) {
    while (next < ours.size() && ours[next].first < key) ++next;
    if (next == ours.size() || ours[next].first != key) return std::nullopt;
    triangles[face] = ours[next++].second;
  }
  return triangles;
}

absl::StatusOr<EncodedMesh> EncodePoints(const PolygonMesh& mesh,
                                         const CornerTriangles& triangles,
                                         const PointMesh& points,
                                         const EncodeOptions& options,
                                         EncodeMethod method) {
  MARROW_ASSIGN_OR_RETURN(OrderedPayload payload,
                          EncodeInOrder(points, options, method));
  std::optional<std::vector<uint32_t>> triangle_of_face =
      MatchFaces(points, payload.decoded);
  if (!triangle_of_face.has_value()) {
    return absl::InternalError(
        "a decoded face is none of the mesh; try the sequential method");
  }
  PayloadOrigin origin;
  origin.site_of_vertex = points.sites.index;
  origin.triangle_begin = triangles.begin;
  origin.triangles.reserve(triangles.corners.size());
  for (const Corners& c : triangles.corners) {
    origin.triangles.push_back({mesh.face_vertices[c[0]],
                                mesh.face_vertices[c[1]],
                                mesh.face_vertices[c[2]]});
  }
  origin.triangle_of_decoded_face = *std::move(triangle_of_face);
  origin.site_of_decoded_point = std::move(payload.decoded.point_site);
  EncodedMesh encoded;
  encoded.bytes = std::move(payload.bytes);
  encoded.method = method;
  encoded.order = OrderMap(mesh, origin);
  return encoded;
}

absl::Status CheckOptions(const EncodeOptions& options) {
  if (options.speed < 0 || options.speed > 10) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the encoder's speed is ", options.speed, "; use 0 to 10"));
  }
  if (options.quantization_bits < 0 ||
      options.quantization_bits > kMaxQuantizationBits) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the number of quantization bits is ", options.quantization_bits,
        "; use 1 to ", kMaxQuantizationBits, ", or 0 for none"));
  }
  return absl::OkStatus();
}

bool AreFiniteAsFloats(const std::vector<std::array<double, 3>>& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const auto& p) {
    return std::isfinite(ToFloat(p[0])) && std::isfinite(ToFloat(p[1])) &&
           std::isfinite(ToFloat(p[2]));
  });
}

absl::StatusOr<EncodedMesh> EncodeChecked(const PolygonMesh& mesh,
                                          EncodeOptions options) {
  const CornerTriangles triangles = TriangulateAll(mesh);
  if (triangles.corners.empty()) {
    return absl::InvalidArgumentError(
        "the mesh has no face with three corners or more; Marrow needs a "
        "surface");
  }
  if (triangles.corners.size() > kMaxTriangles) {
    return absl::InvalidArgumentError(
        absl::StrCat("the mesh has ", triangles.corners.size(),
                     " triangles, more than Draco can hold; simplify it"));
  }
  const PointMesh points =
      BuildPointMesh(mesh, triangles, options.keep_attributes);
  if (!AreFiniteAsFloats(points.sites.rows)) options.quantization_bits = 0;

  if (options.method != EncodeMethod::kAuto) {
    return EncodePoints(mesh, triangles, points, options, options.method);
  }
  if (SuitsEdgebreaker(points)) {
    absl::StatusOr<EncodedMesh> encoded = EncodePoints(
        mesh, triangles, points, options, EncodeMethod::kEdgebreaker);
    if (encoded.ok() &&
        encoded->order.NumDecodedFaces() == triangles.corners.size()) {
      return encoded;
    }
  }
  return EncodePoints(mesh, triangles, points, options,
                      EncodeMethod::kSequential);
}

}  // namespace

absl::StatusOr<EncodedMesh> EncodeMesh(const PolygonMesh& mesh,
                                       const EncodeOptions& options) {
  MARROW_RETURN_IF_ERROR(CheckOptions(options));
  try {
    return EncodeChecked(mesh, options);
  } catch (const std::exception& e) {  // out of memory
    return absl::ResourceExhaustedError(
        absl::StrCat("the mesh cannot be encoded: ", e.what()));
  }
}

}  // namespace marrow
