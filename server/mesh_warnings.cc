#include "server/mesh_warnings.h"

#include <Eigen/Core>
#include <string>

#include "absl/strings/str_cat.h"

namespace marrow {
namespace {

// Coordinates of 24 bits that lie so many times the mesh's extent away from the
// origin leave it fewer than 8 bits.
constexpr double kFarAway = 1e5;

std::string Count(uint64_t count, const char* one, const char* many) {
  return absl::StrCat(count, " ", count == 1 ? one : many);
}

double DistanceInExtents(const MeshReport& report) {
  const double distance =
      report.box_min.cwiseAbs().cwiseMax(report.box_max.cwiseAbs()).maxCoeff();
  return distance / (report.box_max - report.box_min).maxCoeff();
}

}  // namespace

std::vector<v1::Warning> WarningsAbout(const MeshReport& report) {
  std::vector<v1::Warning> warnings;
  const auto warn = [&warnings](const char* code, std::string message) {
    v1::Warning& warning = warnings.emplace_back();
    warning.set_code(code);
    warning.set_message(std::move(message));
  };
  if (report.components > 1) {
    warn("COMPONENTS_BRIDGED",
         absl::StrCat("the mesh is in ", report.components,
                      " pieces that do not touch; they are taken for one body, "
                      "joined where they are nearest"));
  }
  if (report.degenerate_faces > 0) {
    warn("DEGENERATE_FACES",
         absl::StrCat(
             Count(report.degenerate_faces, "face has", "faces have"),
             " two corners at one position; each has a neighbour's label"));
  }
  if (report.duplicate_faces > 0) {
    warn("DUPLICATE_FACES",
         absl::StrCat(
             Count(report.duplicate_faces, "face has", "faces have"),
             " the same corners as another, and the label of that one"));
  }
  if (report.nonmanifold_edges > 0) {
    warn("NONMANIFOLD_EDGES",
         absl::StrCat(
             Count(report.nonmanifold_edges, "edge has", "edges have"),
             " more than two faces; what meets there counts as connected"));
  }
  if (report.unused_points > 0) {
    warn("UNUSED_POINTS",
         absl::StrCat(Count(report.unused_points, "point is", "points are"),
                      " in no face, and without a label"));
  }
  if (DistanceInExtents(report) > kFarAway) {
    warn("FAR_FROM_ORIGIN",
         absl::StrCat("the mesh lies ", DistanceInExtents(report),
                      " times its own size away from the origin, where "
                      "coordinates have few digits left for its shape; move it "
                      "to the origin where it was made"));
  }
  return warnings;
}

}  // namespace marrow
