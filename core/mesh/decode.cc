#include "core/mesh/decode.h"

#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/mesh/draco_header.h"
#include "draco/compression/config/decoder_options.h"
#include "draco/compression/mesh/mesh_edgebreaker_decoder.h"
#include "draco/compression/mesh/mesh_sequential_decoder.h"
#include "draco/core/decoder_buffer.h"
#include "draco/mesh/mesh.h"

namespace marrow {
namespace {

absl::Status Undecodable(const std::string& what) {
  return WithReason(absl::InvalidArgumentError(what), kReasonDracoDecodeFailed);
}

absl::Status Rejected(const std::string& what) {
  return WithReason(absl::InvalidArgumentError(what), kReasonMeshRejected);
}

constexpr uint32_t kCheckCancelEvery = 1 << 16;

absl::Status CheckConnectivity(const draco::Mesh& mesh,
                               const MeshLimits& limits,
                               const CancelToken& cancel) {
  const uint32_t points = mesh.num_points();
  if (points > limits.max_vertices) {
    return Rejected(absl::StrCat("the mesh has ", points,
                                 " points, the limit is ", limits.max_vertices,
                                 "; simplify it or remove attributes whose "
                                 "seams split its vertices"));
  }
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    if (f % kCheckCancelEvery == 0) MARROW_RETURN_IF_ERROR(cancel.Check());
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f))) {
      if (corner.value() >= points) {
        return Rejected(absl::StrCat("face ", f, " refers to point ",
                                     corner.value(), ", but there are only ",
                                     points, " points"));
      }
    }
  }
  return absl::OkStatus();
}

// Draco's decoder, stopped where the counts that it is about to allocate for
// have become known: behind the connectivity, before the attributes.
template <typename Base>
class GuardedDecoder : public Base {
 public:
  GuardedDecoder(std::string_view bytes, DracoMethod method,
                 const MeshLimits& limits, const CancelToken& cancel)
      : bytes_(bytes), method_(method), limits_(limits), cancel_(cancel) {}

  // Why a guard stopped the decoding; OK where none did.
  const absl::Status& verdict() const { return verdict_; }

 protected:
  bool DecodePointAttributes() override {
    const size_t offset = this->buffer()->data_head() - bytes_.data();
    verdict_ = CheckConnectivity(*this->mesh(), limits_, cancel_);
    if (verdict_.ok()) {
      verdict_ = CheckDracoAttributes(bytes_, offset, method_,
                                      this->mesh()->num_points());
    }
    return verdict_.ok() && Base::DecodePointAttributes();
  }

 private:
  const std::string_view bytes_;
  const DracoMethod method_;
  const MeshLimits limits_;
  const CancelToken& cancel_;
  absl::Status verdict_;
};

template <typename Base>
absl::Status RunDecoder(std::string_view bytes, DracoMethod method,
                        const MeshLimits& limits, const CancelToken& cancel,
                        draco::Mesh& mesh) {
  GuardedDecoder<Base> decoder(bytes, method, limits, cancel);
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  const draco::DecoderOptions options;
  const draco::Status status = decoder.Decode(options, &buffer, &mesh);
  MARROW_RETURN_IF_ERROR(decoder.verdict());
  if (status.ok()) return absl::OkStatus();
  return Undecodable(
      absl::StrCat("Draco cannot decode the mesh: ", status.error_msg_string(),
                   " The file is damaged; encode it again"));
}

absl::Status RunDecoder(std::string_view bytes, DracoMethod method,
                        const MeshLimits& limits, const CancelToken& cancel,
                        draco::Mesh& mesh) {
  if (method == DracoMethod::kSequential) {
    return RunDecoder<draco::MeshSequentialDecoder>(bytes, method, limits,
                                                    cancel, mesh);
  }
  return RunDecoder<draco::MeshEdgebreakerDecoder>(bytes, method, limits,
                                                   cancel, mesh);
}

// REQUIRES: every value of the attribute is three Scalars, all in its buffer.
template <typename Scalar>
absl::Status CopyPositions(const draco::PointAttribute& attribute,
                           const CancelToken& cancel, Positions& positions) {
  for (Eigen::Index p = 0; p < positions.rows(); ++p) {
    if (p % kCheckCancelEvery == 0) MARROW_RETURN_IF_ERROR(cancel.Check());
    const draco::AttributeValueIndex value =
        attribute.mapped_index(draco::PointIndex(static_cast<uint32_t>(p)));
    if (value.value() >= attribute.size()) {
      return Undecodable(absl::StrCat("point ", p, " has no position"));
    }
    Scalar xyz[3];
    std::memcpy(xyz, attribute.GetAddress(value), sizeof(xyz));
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(xyz[i])) {
        return Rejected(absl::StrCat("the position of point ", p,
                                     " is not finite; repair the mesh"));
      }
      positions(p, i) = xyz[i];
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<Positions> ExtractPositions(const draco::Mesh& mesh,
                                           const CancelToken& cancel) {
  using draco::GeometryAttribute;
  const draco::PointAttribute* attribute =
      mesh.GetNamedAttribute(GeometryAttribute::POSITION);
  if (mesh.NumNamedAttributes(GeometryAttribute::POSITION) != 1 ||
      attribute->num_components() != 3) {
    return Rejected("the mesh must have one POSITION of 3 components");
  }
  const bool is_double = attribute->data_type() == draco::DT_FLOAT64;
  const int64_t value_size = 3 * (is_double ? sizeof(double) : sizeof(float));
  if (!attribute->is_mapping_identity() &&
      attribute->indices_map_size() < mesh.num_points()) {
    return Undecodable("POSITION has fewer entries than the mesh has points");
  }
  if (attribute->byte_stride() != value_size || attribute->byte_offset() != 0 ||
      attribute->buffer() == nullptr ||
      attribute->buffer()->data_size() < attribute->size() * value_size) {
    return Undecodable("POSITION has fewer values than it declares");
  }
  Positions positions(mesh.num_points(), 3);
  MARROW_RETURN_IF_ERROR(
      is_double ? CopyPositions<double>(*attribute, cancel, positions)
                : CopyPositions<float>(*attribute, cancel, positions));
  return positions;
}

absl::StatusOr<DecodedMesh> DecodeOrThrow(std::string_view bytes,
                                          const MeshLimits& limits,
                                          const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(const DracoHeader header,
                          ParseDracoHeader(bytes, limits));
  draco::Mesh mesh;
  MARROW_RETURN_IF_ERROR(
      RunDecoder(bytes, header.method, limits, cancel, mesh));
  MARROW_RETURN_IF_ERROR(CheckConnectivity(mesh, limits, cancel));
  if (mesh.num_faces() != header.faces) {
    return Undecodable(absl::StrCat("the mesh declares ", header.faces,
                                    " faces but has ", mesh.num_faces()));
  }
  DecodedMesh decoded;
  MARROW_ASSIGN_OR_RETURN(decoded.positions, ExtractPositions(mesh, cancel));
  decoded.faces.reserve(mesh.num_faces());
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    decoded.faces.push_back(
        {face[0].value(), face[1].value(), face[2].value()});
  }
  MARROW_RETURN_IF_ERROR(cancel.Check());
  return decoded;
}

}  // namespace

absl::StatusOr<DecodedMesh> DecodeDraco(std::string_view bytes,
                                        const MeshLimits& limits,
                                        const CancelToken& cancel) {
  try {
    return DecodeOrThrow(bytes, limits, cancel);
  } catch (const std::bad_alloc&) {
    return Undecodable("decoding the mesh takes more memory than there is");
  } catch (const std::exception&) {
    return Undecodable("Draco failed on the mesh; encode it again");
  }
}

}  // namespace marrow
