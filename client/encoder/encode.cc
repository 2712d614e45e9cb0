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
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/mesh_file/triangulate.h"
#include "client/segmentation.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

using client::kNone;

using Corners = std::array<uint32_t, 3>;

// Draco counts corners in 32 bits, some of them signed.
constexpr size_t kMaxTriangles = size_t{1} << 29;

// Rows of floats with equal ones (to the bit) put together, in order of first
// appearance.
template <size_t N>
struct DistinctRows {
  std::vector<std::array<float, N>> rows;
  std::vector<uint32_t> index;  // an input row -> its place in `rows`
};

template <size_t N>
DistinctRows<N> FindDistinct(const std::vector<std::array<float, N>>& input) {
  DistinctRows<N> distinct;
  distinct.index.reserve(input.size());
  absl::flat_hash_map<std::array<uint32_t, N>, uint32_t> seen;
  seen.reserve(input.size());
  for (const std::array<float, N>& row : input) {
    const auto [entry, is_new] =
        seen.try_emplace(std::bit_cast<std::array<uint32_t, N>>(row),
                         static_cast<uint32_t>(distinct.rows.size()));
    if (is_new) distinct.rows.push_back(row);
    distinct.index.push_back(entry->second);
  }
  return distinct;
}

// The mesh as Draco sees it: a point is a site with the texture coordinates and
// the normal that a corner has there.
struct Soup {
  DistinctRows<3> sites;  // of the file's vertices
  DistinctRows<2> uvs;    // of corners; empty where not sent
  DistinctRows<3> normals;
  std::vector<Corners> faces;         // points
  std::vector<Corners> site_corners;  // sites, parallel to faces
  std::vector<uint32_t> point_site;
  std::vector<uint32_t> point_uv;
  std::vector<uint32_t> point_normal;
  bool has_unused_points = false;  // that no face has
};

// Triangles with the places of their corners in face_vertices, so that what a
// corner carries is found again.
struct CornerTriangles {
  std::vector<uint32_t> begin = {0};  // by face
  std::vector<Corners> corners;
};

CornerTriangles TriangulateAll(const PolygonMesh& mesh) {
  // A stand-in whose "vertices" are the corners themselves.
  PolygonMesh face;
  std::vector<Corners> cut;
  CornerTriangles all;
  all.begin.reserve(mesh.NumFaces() + 1);
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const std::span<const uint32_t> vertices = mesh.Face(f);
    const uint32_t first = mesh.face_offsets[f];
    if (vertices.size() == 3) {
      all.corners.push_back({first, first + 1, first + 2});
    } else if (vertices.size() > 3) {
      face.positions.clear();
      face.face_vertices.clear();
      for (const uint32_t v : vertices) {
        face.face_vertices.push_back(
            static_cast<uint32_t>(face.positions.size()));
        face.positions.push_back(mesh.positions[v]);
      }
      face.face_offsets = {0, static_cast<uint32_t>(vertices.size())};
      cut.clear();
      Triangulate(face, 0, &cut);
      for (const Corners& c : cut) {
        all.corners.push_back({first + c[0], first + c[1], first + c[2]});
      }
    }
    all.begin.push_back(static_cast<uint32_t>(all.corners.size()));
  }
  return all;
}

// Numbers points as they are first asked for.
class PointTable {
 public:
  explicit PointTable(Soup* soup) : soup_(*soup) {}

  // A site, a row of uvs and a row of normals.
  uint32_t FindOrAdd(const Corners& key) {
    const auto [entry, is_new] = points_.try_emplace(
        key, static_cast<uint32_t>(soup_.point_site.size()));
    if (is_new) {
      soup_.point_site.push_back(key[0]);
      soup_.point_uv.push_back(key[1]);
      soup_.point_normal.push_back(key[2]);
    }
    return entry->second;
  }

 private:
  Soup& soup_;
  absl::flat_hash_map<Corners, uint32_t> points_;
};

std::vector<bool> UsedSites(const Soup& soup) {
  std::vector<bool> used(soup.sites.rows.size(), false);
  for (const Corners& corners : soup.site_corners) {
    for (const uint32_t site : corners) used[site] = true;
  }
  return used;
}

// Points that no face has come last, unless there are so many that Draco would
// not decode them: it allows three points a face.
void AddUnusedPoints(const std::vector<bool>& used, PointTable* table,
                     Soup* soup) {
  const size_t unused =
      static_cast<size_t>(std::count(used.begin(), used.end(), false));
  if (soup->point_site.size() + unused > 3 * soup->faces.size()) return;
  for (uint32_t s = 0; s < used.size(); ++s) {
    if (!used[s]) table->FindOrAdd({s, 0, 0});
  }
  soup->has_unused_points = unused > 0;
}

// Without attributes points are numbered as sites are, with them by corners.
void AddPoints(const PolygonMesh& mesh, const CornerTriangles& triangles,
               bool keep_attributes, Soup* soup) {
  const bool has_uvs = keep_attributes && !mesh.corner_uvs.empty();
  const bool has_normals = keep_attributes && !mesh.corner_normals.empty();
  if (has_uvs) soup->uvs = FindDistinct(mesh.corner_uvs);
  if (has_normals) soup->normals = FindDistinct(mesh.corner_normals);
  for (const Corners& triangle : triangles.corners) {
    Corners sites;
    for (int i = 0; i < 3; ++i) {
      sites[i] = soup->sites.index[mesh.face_vertices[triangle[i]]];
    }
    soup->site_corners.push_back(sites);
  }
  const std::vector<bool> used = UsedSites(*soup);
  PointTable table(soup);
  if (!has_uvs && !has_normals) {
    for (uint32_t s = 0; s < used.size(); ++s) {
      if (used[s]) table.FindOrAdd({s, 0, 0});
    }
  }
  for (size_t t = 0; t < triangles.corners.size(); ++t) {
    Corners points;
    for (int i = 0; i < 3; ++i) {
      const uint32_t corner = triangles.corners[t][i];
      points[i] = table.FindOrAdd(
          {soup->site_corners[t][i], has_uvs ? soup->uvs.index[corner] : 0,
           has_normals ? soup->normals.index[corner] : 0});
    }
    soup->faces.push_back(points);
  }
  AddUnusedPoints(used, &table, soup);
}

bool KeptByEdgebreaker(const Corners& sites) {
  return sites[0] != sites[1] && sites[1] != sites[2] && sites[2] != sites[0];
}

// Edgebreaker pairs the half-edges at a vertex by comparing all with all.
bool IsQuickForEdgebreaker(const std::vector<uint64_t>& degrees,
                           size_t num_triangles) {
  constexpr uint64_t kFixedComparisons = 100'000'000;
  constexpr uint64_t kComparisonsPerTriangle = 100;
  uint64_t comparisons = 0;
  for (const uint64_t degree : degrees) comparisons += degree * degree;
  return comparisons <=
         kFixedComparisons + kComparisonsPerTriangle * num_triangles;
}

bool SuitsEdgebreaker(const Soup& soup) {
  if (soup.has_unused_points) return false;
  std::vector<uint64_t> degrees(soup.sites.rows.size(), 0);
  for (const Corners& sites : soup.site_corners) {
    if (!KeptByEdgebreaker(sites)) return false;
    for (const uint32_t site : sites) ++degrees[site];
  }
  return IsQuickForEdgebreaker(degrees, soup.site_corners.size());
}

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

void AddSiteNumbers(const Soup& soup, draco::Mesh* mesh) {
  std::vector<std::array<uint32_t, 1>> numbers(soup.sites.rows.size());
  for (uint32_t s = 0; s < numbers.size(); ++s) numbers[s] = {s};
  AddAttribute(draco::GeometryAttribute::GENERIC, draco::DT_UINT32, numbers,
               soup.point_site, mesh);
}

std::unique_ptr<draco::Mesh> ToDraco(const Soup& soup, bool number_sites) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<uint32_t>(soup.point_site.size()));
  mesh->SetNumFaces(soup.faces.size());
  for (uint32_t f = 0; f < soup.faces.size(); ++f) {
    const Corners& c = soup.faces[f];
    mesh->SetFace(draco::FaceIndex(f),
                  {draco::PointIndex(c[0]), draco::PointIndex(c[1]),
                   draco::PointIndex(c[2])});
  }
  AddAttribute(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32,
               soup.sites.rows, soup.point_site, mesh.get());
  if (!soup.uvs.rows.empty()) {
    AddAttribute(draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32,
                 soup.uvs.rows, soup.point_uv, mesh.get());
  }
  if (!soup.normals.rows.empty()) {
    AddAttribute(draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32,
                 soup.normals.rows, soup.point_normal, mesh.get());
  }
  if (number_sites) AddSiteNumbers(soup, mesh.get());
  return mesh;
}

absl::StatusOr<std::string> RunEncoder(const Soup& soup,
                                       const EncodeOptions& options,
                                       EncodeMethod method, bool number_sites) {
  const std::unique_ptr<draco::Mesh> mesh = ToDraco(soup, number_sites);
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
  std::vector<Corners> faces;                      // points
  std::vector<std::array<uint32_t, 3>> positions;  // bits, by point
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

// A payload and the site of each point as it decodes.
struct OrderedPayload {
  std::string bytes;
  Decoded decoded;
};

absl::StatusOr<OrderedPayload> EncodeInOrder(const Soup& soup,
                                             const EncodeOptions& options,
                                             EncodeMethod method) {
  OrderedPayload payload;
  MARROW_ASSIGN_OR_RETURN(payload.bytes,
                          RunEncoder(soup, options, method, false));
  MARROW_ASSIGN_OR_RETURN(payload.decoded, RunDecoder(payload.bytes));
  if (payload.decoded.faces == soup.faces &&
      payload.decoded.positions.size() == soup.point_site.size()) {
    payload.decoded.point_site = soup.point_site;
    return payload;
  }
  MARROW_ASSIGN_OR_RETURN(std::string numbered_bytes,
                          RunEncoder(soup, options, method, true));
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
std::optional<std::vector<uint32_t>> MatchFaces(const Soup& soup,
                                                const Decoded& decoded) {
  std::vector<Corners> decoded_sites;
  decoded_sites.reserve(decoded.faces.size());
  for (const Corners& face : decoded.faces) {
    decoded_sites.push_back({decoded.point_site[face[0]],
                             decoded.point_site[face[1]],
                             decoded.point_site[face[2]]});
  }
  const KeyedFaces ours = SortByKey(soup.site_corners);
  std::vector<uint32_t> triangles(decoded.faces.size());
  size_t next = 0;
  for (const auto& [key, face] : SortByKey(decoded_sites)) {
    while (next < ours.size() && ours[next].first < key) ++next;
    if (next == ours.size() || ours[next].first != key) return std::nullopt;
    triangles[face] = ours[next++].second;
  }
  return triangles;
}

absl::StatusOr<EncodedMesh> EncodeSoup(const PolygonMesh& mesh,
                                       const CornerTriangles& triangles,
                                       const Soup& soup,
                                       const EncodeOptions& options,
                                       EncodeMethod method) {
  MARROW_ASSIGN_OR_RETURN(OrderedPayload payload,
                          EncodeInOrder(soup, options, method));
  std::optional<std::vector<uint32_t>> triangle_of_face =
      MatchFaces(soup, payload.decoded);
  if (!triangle_of_face.has_value()) {
    return absl::InternalError(
        "a decoded face is none of the mesh; try the sequential method");
  }
  PayloadOrigin origin;
  origin.site_of_vertex = soup.sites.index;
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
  if (options.quantization_bits < 0 || options.quantization_bits > 30) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the number of quantization bits is ", options.quantization_bits,
        "; use 1 to 30, or 0 for none"));
  }
  return absl::OkStatus();
}

bool IsFinite(const std::vector<std::array<float, 3>>& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const auto& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
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
  Soup soup;
  soup.sites = FindDistinct(mesh.positions);
  AddPoints(mesh, triangles, options.keep_attributes, &soup);
  if (!IsFinite(soup.sites.rows)) options.quantization_bits = 0;

  if (options.method != EncodeMethod::kAuto) {
    return EncodeSoup(mesh, triangles, soup, options, options.method);
  }
  if (SuitsEdgebreaker(soup)) {
    absl::StatusOr<EncodedMesh> encoded =
        EncodeSoup(mesh, triangles, soup, options, EncodeMethod::kEdgebreaker);
    if (encoded.ok() &&
        encoded->order.NumDecodedFaces() == triangles.corners.size()) {
      return encoded;
    }
  }
  return EncodeSoup(mesh, triangles, soup, options, EncodeMethod::kSequential);
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
