#include "server/mesh_warnings.h"

#include <Eigen/Core>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/operators/bodies.h"

namespace marrow {
namespace {

// Coordinates of 24 bits that lie so many times the mesh's extent away from the
// origin leave it fewer than 8 bits.
constexpr double kFarAway = 1e5;

double DistanceInExtents(const MeshReport& report) {
  const double distance =
      report.box_min.cwiseAbs().cwiseMax(report.box_max.cwiseAbs()).maxCoeff();
  return distance / (report.box_max - report.box_min).maxCoeff();
}

// A kind of finding. `one` and `many` go on after the count, and tell what is
// done.
struct Kind {
  const char* code;
  bool is_warning;
  uint64_t MeshReport::*count;
  const char* one;
  const char* many;
};

constexpr Kind kKinds[] = {
    {"WELDED_POINTS", false, &MeshReport::welded_points,
     "point of the payload lies where another does, as at a seam or where the "
     "surface is not manifold; it is welded to it",
     "points of the payload lie where others do, as at seams and where the "
     "surface is not manifold; they are welded to those"},
    {"CRACKS", true, &MeshReport::crack_points,
     "vertex lies beside another with a crack between them; they are made one",
     "vertices lie beside others with cracks between them; they are made one "
     "with those"},
    {"T_JUNCTIONS", true, &MeshReport::t_junctions,
     "vertex lies inside an open edge; the face there is split at it",
     "vertices lie inside open edges; the faces there are split at them"},
    {"DEGENERATE_FACES", true, &MeshReport::degenerate_faces,
     "face has two corners at one position; it has a neighbour's label",
     "faces have two corners at one position; each has a neighbour's label"},
    {"DUPLICATE_FACES", true, &MeshReport::duplicate_faces,
     "face has the same corners as another, and the label of that one",
     "faces have the same corners as another, and the label of that one"},
    {"INNER_WALL_FACES", true, &MeshReport::inner_wall_faces,
     "face is inside, back to back with another; it has the label of a face "
     "beside it",
     "faces are inside, where shells lie flush against each other; they have "
     "the labels of faces beside them"},
    {"ZERO_AREA_FACES", false, &MeshReport::zero_area_faces,
     "face has its corners on one line; its edges are lengthened a little",
     "faces have their corners on one line; all edges are lengthened a little"},
    {"SLIVER_FACES", false, &MeshReport::sliver_faces,
     "face has an angle under one degree; its edges are flipped inside of the "
     "surface",
     "faces have an angle under one degree; their edges are flipped inside of "
     "the surface"},
    {"FLIPPED_FACES", false, &MeshReport::flipped_faces,
     "face is turned against its neighbours, which does not matter",
     "faces are turned against their neighbours, which does not matter"},
    {"NONMANIFOLD_EDGES", true, &MeshReport::nonmanifold_edges,
     "edge has more than two faces; what meets there counts as connected",
     "edges have more than two faces; what meets there counts as connected"},
    {"NONMANIFOLD_VERTICES", false, &MeshReport::nonmanifold_vertices,
     "vertex joins parts that share no edge; they count as touching",
     "vertices join parts that share no edge; they count as touching"},
    {"BOUNDARIES", false, &MeshReport::boundary_loops,
     "hole or open border; it is left open and is no joint",
     "holes or open borders; they are left open and are no joints"},
    {"COMPONENTS_BRIDGED", true, &MeshReport::bridged_components,
     "component is joined with another",
     "components are so near to each other that they are segmented as if they "
     "had grown together"},
    {"COMPONENTS_ATTACHED", true, &MeshReport::attached_components,
     "component is too small to be segmented, and has the label of the nearest "
     "part",
     "components are too small to be segmented, and have the label of the "
     "nearest part"},
    {"COMPONENTS_WORN", false, &MeshReport::worn_components,
     "component lies all over on larger ones, as clothes do, and has the "
     "labels "
     "beneath it",
     "components lie all over on larger ones, as clothes do, and have the "
     "labels beneath them"},
    {"COARSENED", false, &MeshReport::coarse_vertices,
     "vertex is left of a mesh so large; its parts are found on that",
     "vertices are left of a mesh so large for its parts to be found on; its "
     "own faces have the labels of theirs"},
    {"UNUSED_POINTS", true, &MeshReport::unused_points,
     "point is in no face, and without a label",
     "points are in no face, and without a label"},
};

v1::Finding MakeFinding(const char* code, uint64_t count,
                        const std::string& message) {
  v1::Finding finding;
  finding.set_code(code);
  finding.set_count(static_cast<uint32_t>(count));
  finding.set_message(message);
  return finding;
}

std::string Describe(const Kind& kind, uint64_t count,
                     const MeshReport& report) {
  const bool is_one = count == 1;
  // Beyond the last body, however large.
  if (kind.count == &MeshReport::attached_components &&
      report.bodies >= kMaxBodies) {
    return absl::StrCat(count, is_one ? " component is" : " components are",
                        " too small to be segmented, or beyond the ",
                        kMaxBodies, " largest bodies, and ",
                        is_one ? "has" : "have",
                        " the label of the nearest part");
  }
  return absl::StrCat(count, " ", is_one ? kind.one : kind.many);
}

bool IsWarning(const std::string& code) {
  for (const Kind& kind : kKinds)
    if (code == kind.code) return kind.is_warning;
  return true;
}

}  // namespace

std::vector<v1::Finding> FindingsAbout(const MeshReport& report) {
  std::vector<v1::Finding> findings;
  for (const Kind& kind : kKinds) {
    const uint64_t count = report.*kind.count;
    if (count == 0) continue;
    findings.push_back(
        MakeFinding(kind.code, count, Describe(kind, count, report)));
  }
  if (report.bodies > 1) {
    findings.push_back(MakeFinding(
        "SEVERAL_BODIES", report.bodies,
        absl::StrCat(
            "the mesh is ", report.bodies,
            " bodies, apart from each other or one the surroundings of "
            "others; each is segmented on its own, at a scale of its "
            "own, and no segment of level 1 or deeper has faces of "
            "two")));
  }
  if (DistanceInExtents(report) > kFarAway) {
    findings.push_back(MakeFinding(
        "FAR_FROM_ORIGIN", 1,
        absl::StrCat("the mesh lies ", DistanceInExtents(report),
                     " times its own size away from the origin, where "
                     "coordinates of single precision have few digits left "
                     "for its shape; if it was made with those, move it to the "
                     "origin there")));
  }
  return findings;
}

std::vector<v1::Warning> WarningsAbout(const MeshReport& report) {
  std::vector<v1::Warning> warnings;
  for (v1::Finding& finding : FindingsAbout(report)) {
    if (!IsWarning(finding.code())) continue;
    v1::Warning& warning = warnings.emplace_back();
    warning.set_code(std::move(*finding.mutable_code()));
    warning.set_message(std::move(*finding.mutable_message()));
  }
  return warnings;
}

}  // namespace marrow
