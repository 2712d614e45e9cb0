#include "core/operators/body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/status_macros.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/submesh.h"
#include "core/operators/seams.h"

namespace marrow {
namespace {

// Vertices that are sewn together become one, where the least of them is.
// The report is of no use once cancelled.
void Sew(const std::vector<uint32_t>& sewn, const CancelToken& cancel,
         Submesh& own, Body& body) {
  TriangleMesh& mesh = own.canonical.mesh;
  std::vector<uint32_t> number(sewn.size());
  uint32_t count = 0;
  for (uint32_t v = 0; v < sewn.size(); ++v) {
    if (sewn[v] != v) {
      number[v] = number[sewn[v]];
      body.seams.push_back({own.vertices[number[v]], own.vertices[v]});
      continue;
    }
    number[v] = count;
    mesh.positions.row(count) = mesh.positions.row(v);
    own.vertices[count++] = own.vertices[v];
  }
  if (body.seams.empty()) return;
  std::sort(body.seams.begin(), body.seams.end());
  mesh.positions.conservativeResize(count, 3);
  own.vertices.resize(count);
  for (Triangle& face : mesh.faces)
    for (uint32_t& v : face) v = number[v];
  own.canonical.report = ReportOn(mesh, cancel);
  own.canonical.geometry_digest = GeometryDigestOf(mesh);
}

// Vertices that are sewn together to the mean of their places.
void MoveToMeans(const std::vector<uint32_t>& sewn, Positions& positions) {
  Positions sums = Positions::Zero(positions.rows(), 3);
  std::vector<double> count(sewn.size(), 0);
  for (uint32_t v = 0; v < sewn.size(); ++v) ++count[sewn[v]];
  for (uint32_t v = 0; v < sewn.size(); ++v)
    sums.row(sewn[v]) += positions.row(v) / count[sewn[v]];
  for (uint32_t v = 0; v < sewn.size(); ++v)
    if (count[v] > 1) positions.row(v) = sums.row(v);
}

}  // namespace

absl::StatusOr<Body> MakeBody(const TriangleMesh& mesh,
                              std::vector<uint32_t> faces, bool has_shells,
                              bool are_shreds, const CancelToken& cancel) {
  Submesh own = ExtractFaces(mesh, faces, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  Body body;
  if (has_shells) {
    TriangleMesh& shells = own.canonical.mesh;
    std::vector<uint32_t> sewn;
    if (are_shreds) {
      MARROW_ASSIGN_OR_RETURN(sewn, SewShreds(shells, cancel));
      MoveToMeans(sewn, shells.positions);
    } else {
      sewn = SewRims(shells, BridgingDistance(shells), cancel);
    }
    MARROW_RETURN_IF_ERROR(cancel.Check());
    Sew(sewn, cancel, own, body);
    MARROW_RETURN_IF_ERROR(cancel.Check());
  }
  body.bridges = FindBridges(own.canonical.mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  body.canonical =
      std::make_shared<const CanonicalMesh>(std::move(own.canonical));
  body.faces = std::move(faces);
  body.vertices = std::move(own.vertices);
  return body;
}

std::vector<bool> PatchesOf(const Body& body) {
  if (body.patched == nullptr) return {};
  std::vector<bool> is_patch(body.Computed().mesh.NumFaces(), true);
  for (uint32_t f = 0; f < body.faces.size(); ++f)
    is_patch[body.coarse == nullptr ? f : body.coarse->coarse_face[f]] = false;
  return is_patch;
}

std::vector<uint32_t> ToWholeVertices(const Body& body,
                                      const TriangleMesh& whole,
                                      std::vector<uint32_t> own,
                                      const std::vector<uint32_t>& faces) {
  for (uint32_t& v : own) v = body.vertices[v];
  own.erase(std::unique(own.begin(), own.end()), own.end());
  if (body.seams.empty()) return own;
  std::vector<uint32_t> corners;
  for (uint32_t f : faces)
    corners.insert(corners.end(), whole.faces[f].begin(), whole.faces[f].end());
  std::sort(corners.begin(), corners.end());
  const auto has = [&](uint32_t v) {
    return std::binary_search(corners.begin(), corners.end(), v);
  };
  for (uint32_t& v : own) {
    if (has(v)) continue;
    auto seam =
        std::lower_bound(body.seams.begin(), body.seams.end(), Bridge{v, 0});
    for (; seam != body.seams.end() && (*seam)[0] == v; ++seam)
      if (has((*seam)[1])) break;
    if (seam != body.seams.end() && (*seam)[0] == v) v = (*seam)[1];
  }
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  return own;
}

uint32_t PairsOfBody(const Body& body, uint32_t count) {
  constexpr uint32_t kLeast = 60;
  // Not one more for what rounding adds to the share.
  const double share = std::ceil(body.share * count - 1e-6);
  return std::min(count, std::max(kLeast, static_cast<uint32_t>(share)));
}

}  // namespace marrow
