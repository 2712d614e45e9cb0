#include "client/encoder/mesh_payload.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/mesh_file/mesh_file.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// A copy whose message begins with the path; what is attached stays.
absl::Status WithPath(const std::string& path, const absl::Status& status) {
  absl::Status named(status.code(), absl::StrCat(path, ": ", status.message()));
  status.ForEachPayload([&](absl::string_view url, const absl::Cord& payload) {
    named.SetPayload(url, payload);
  });
  return named;
}

PolygonMesh ToPolygons(const DecodedMesh& decoded) {
  PolygonMesh mesh;
  mesh.positions.reserve(static_cast<size_t>(decoded.positions.rows()));
  for (Eigen::Index i = 0; i < decoded.positions.rows(); ++i) {
    const Eigen::RowVector3d point = decoded.positions.row(i);
    mesh.positions.push_back({point.x(), point.y(), point.z()});
  }
  for (const Triangle& face : decoded.faces) mesh.AddFace(face);
  return mesh;
}

// Every vertex is a site of its own: decoded points stay apart.
PayloadOrigin IdentityOrigin(const DecodedMesh& decoded) {
  PayloadOrigin origin;
  origin.site_of_vertex.resize(static_cast<size_t>(decoded.positions.rows()));
  std::iota(origin.site_of_vertex.begin(), origin.site_of_vertex.end(), 0u);
  origin.site_of_decoded_point = origin.site_of_vertex;
  origin.triangles = decoded.faces;
  origin.triangle_begin.resize(decoded.faces.size() + 1);
  std::iota(origin.triangle_begin.begin(), origin.triangle_begin.end(), 0u);
  origin.triangle_of_decoded_face.assign(origin.triangle_begin.begin(),
                                         origin.triangle_begin.end() - 1);
  return origin;
}

// The service would name the point of the payload, which is none of the file's.
absl::Status CheckFinite(const PolygonMesh& mesh) {
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    for (uint32_t v : mesh.Face(f)) {
      const std::array<double, 3>& position = mesh.positions[v];
      if (!std::all_of(position.begin(), position.end(),
                       [](double x) { return std::isfinite(x); }))
        return WithReason(absl::InvalidArgumentError(absl::StrCat(
                              "vertex ", v,
                              ", counted from 0, is not finite; repair the "
                              "mesh")),
                          kReasonMeshRejected);
    }
  }
  return absl::OkStatus();
}

absl::Status CheckTime(absl::Time deadline, const char* done) {
  return absl::Now() < deadline
             ? absl::OkStatus()
             : absl::DeadlineExceededError(absl::StrCat(done, " too late"));
}

}  // namespace

absl::StatusOr<MeshPayload> PayloadFromDraco(std::string bytes,
                                             const MeshLimits& limits) {
  MARROW_ASSIGN_OR_RETURN(const DecodedMesh decoded,
                          DecodeDraco(bytes, limits));
  MeshPayload payload;
  payload.mesh = ToPolygons(decoded);
  payload.encoded.order = OrderMap(payload.mesh, IdentityOrigin(decoded));
  payload.encoded.bytes = std::move(bytes);
  payload.sent_as_it_is = true;
  return payload;
}

absl::StatusOr<MeshPayload> LoadMeshPayload(const std::string& path,
                                            const EncodeOptions& options,
                                            const MeshLimits& limits,
                                            absl::Time deadline) {
  MARROW_ASSIGN_OR_RETURN(std::string bytes, ReadFileBytes(path, deadline));
  if (DetectMeshFormat(path, bytes) == MeshFormat::kDraco) {
    absl::StatusOr<MeshPayload> payload =
        PayloadFromDraco(std::move(bytes), limits);
    return payload.ok() ? std::move(payload) : WithPath(path, payload.status());
  }
  MeshPayload payload;
  MARROW_ASSIGN_OR_RETURN(payload.mesh, ParseMesh(path, bytes));
  MARROW_RETURN_IF_ERROR(CheckTime(deadline, "it was read"));
  if (absl::Status s = CheckFinite(payload.mesh); !s.ok())
    return WithPath(path, s);
  absl::StatusOr<EncodedMesh> encoded = EncodeMesh(payload.mesh, options);
  if (!encoded.ok()) return WithPath(path, encoded.status());
  // Draco cannot hold fewer than three points; all faces are degenerate then.
  if (encoded->order.NumDecodedPoints() < 3) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": all corners of its faces lie at ",
                     encoded->order.NumDecodedPoints() == 1 ? "one position"
                                                            : "two positions",
                     "; Marrow needs a surface"));
  }
  MARROW_RETURN_IF_ERROR(CheckTime(deadline, "it was encoded"));
  payload.encoded = *std::move(encoded);
  return payload;
}

}  // namespace marrow
