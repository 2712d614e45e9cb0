#include "core/mesh/canonical_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/cancellable.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/cracks.h"
#include "core/mesh/inner_walls.h"
#include "core/mesh/orientation.h"
#include "core/mesh/spots.h"
#include "core/mesh/t_junctions.h"

namespace marrow {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the digest is of little-endian bytes");

absl::Status Rejected(const std::string& what) {
  return WithReason(absl::InvalidArgumentError(what), kReasonMeshRejected);
}

// A face between spots, ascending.
struct FaceRecord {
  Triangle spots;
  bool descends;          // the payload has it the other way round
  uint32_t decoded_face;  // none for all but the largest part of one
};

bool IsDegenerate(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

Triangle OnSpots(const Triangle& face, const Spots& spots) {
  return {spots.of_point[face[0]], spots.of_point[face[1]],
          spots.of_point[face[2]]};
}

double TwiceArea(const Triangle& t, const Positions& positions) {
  const Eigen::Vector3d a = positions.row(t[0]).transpose();
  const Eigen::Vector3d b = positions.row(t[1]).transpose();
  const Eigen::Vector3d c = positions.row(t[2]).transpose();
  return (b - a).cross(c - a).stableNorm();
}

// Begins with the least corner; whether the other two then descend. They do not
// any more.
bool MakeAscending(Triangle& t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  if (t[1] < t[2]) return false;
  std::swap(t[1], t[2]);
  return true;
}

void AddFace(const Spots& spots, const FaceRecord& face,
             std::vector<FaceRecord>& records) {
  if (spots.junctions.empty()) return records.push_back(face);
  std::vector<Triangle> parts = SplitAt(spots.junctions, face.spots);
  const auto largest = std::max_element(
      parts.begin(), parts.end(), [&](const Triangle& a, const Triangle& b) {
        return TwiceArea(a, spots.positions) < TwiceArea(b, spots.positions);
      });
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    const bool descends = MakeAscending(*part);
    records.push_back({*part, descends != face.descends,
                       part == largest ? face.decoded_face : kNoIndex});
  }
}

absl::StatusOr<std::vector<FaceRecord>> FacesOnSpots(
    const DecodedMesh& decoded, const Spots& spots, const CancelToken& cancel) {
  std::vector<FaceRecord> records;
  records.reserve(decoded.faces.size());
  const auto record = [&](uint32_t f) {
    Triangle t = OnSpots(decoded.faces[f], spots);
    if (IsDegenerate(t)) return;
    const bool descends = MakeAscending(t);
    AddFace(spots, {t, descends, f}, records);
  };
  MARROW_RETURN_IF_ERROR(ForEachIndex(decoded.faces.size(), cancel, record));
  return records;
}

// Fills result.mesh.faces (still between spots, ascending), the face_map of
// all but degenerate faces, and `directions` of the kept ones. Sorts them.
absl::Status KeepFaces(std::vector<FaceRecord>& records,
                       const CancelToken& cancel, CanonicalMesh& result,
                       std::vector<Directions>& directions) {
  const auto by_spots = [](const FaceRecord& a, const FaceRecord& b) {
    return a.spots < b.spots;
  };
  MARROW_RETURN_IF_ERROR(
      SortUnlessCancelled(records.begin(), records.end(), by_spots, cancel));
  std::vector<Triangle>& faces = result.mesh.faces;
  for (const auto& [spots, descends, decoded_face] : records) {
    if (faces.empty() || faces.back() != spots) {
      faces.push_back(spots);
      directions.emplace_back();
    }
    ++(descends ? directions.back().descending : directions.back().ascending);
    if (decoded_face != kNoIndex)
      result.face_map[decoded_face] = static_cast<uint32_t>(faces.size() - 1);
  }
  return cancel.Check();
}

// Numbers the vertices that are used; the numbers keep their order, so the
// faces stay ascending and sorted. Returns the new number of each, kNoIndex for
// the others.
std::vector<uint32_t> KeepUsedVertices(TriangleMesh& mesh) {
  std::vector<uint32_t> now(mesh.NumVertices(), kNoIndex);
  for (const Triangle& face : mesh.faces)
    for (uint32_t v : face) now[v] = 0;
  uint32_t count = 0;
  for (uint32_t v = 0; v < now.size(); ++v) {
    if (now[v] == kNoIndex) continue;
    mesh.positions.row(count) = mesh.positions.row(v);
    now[v] = count++;
  }
  mesh.positions.conservativeResize(count, 3);
  for (Triangle& face : mesh.faces)
    for (uint32_t& corner : face) corner = now[corner];
  return now;
}

// Takes out the faces that are walls on every side; the payload's faces there
// get the face beside them. How many those are. `outside` is that of
// FindInnerWalls(), not empty.
uint64_t DropInnerWalls(const std::vector<uint32_t>& outside,
                        const std::vector<FaceRecord>& records,
                        CanonicalMesh& result,
                        std::vector<Directions>& directions,
                        std::vector<uint32_t>& vertex_of_spot) {
  std::vector<Triangle>& faces = result.mesh.faces;
  const auto is_wall = [&](uint32_t f) {
    const uint32_t side = 2 * f;
    return outside[side] != kNoIndex &&
           (directions[f].NumSides() == 1 || outside[side + 1] != kNoIndex);
  };
  std::vector<uint32_t> now(faces.size(), kNoIndex);
  uint32_t kept = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (!is_wall(f)) now[f] = kept++;
  uint64_t dropped = 0;
  for (const FaceRecord& record : records) {
    if (record.decoded_face == kNoIndex) continue;
    uint32_t& face = result.face_map[record.decoded_face];
    if (now[face] == kNoIndex) {
      face = outside[SideOf(face, directions[face], record.descends)];
      ++dropped;
    }
    face = now[face];
  }
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (now[f] == kNoIndex) continue;
    faces[now[f]] = faces[f];
    directions[now[f]] = directions[f];
  }
  faces.resize(kept);
  directions.resize(kept);
  const std::vector<uint32_t> vertices = KeepUsedVertices(result.mesh);
  for (uint32_t& vertex : vertex_of_spot)
    if (vertex != kNoIndex) vertex = vertices[vertex];
  return dropped;
}

// The least number of faces that the payload would have to turn over; none of
// those that it has both ways.
uint64_t CountFlipped(const std::vector<Directions>& directions,
                      const Sides& sides) {
  std::vector<std::array<uint64_t, 2>> counts(sides.NumParts());
  for (size_t f = 0; f < directions.size(); ++f) {
    if (!directions[f].AreBoth())
      ++counts[sides.part[f]]
              [(directions[f].descending > 0) != sides.is_turned[f]];
  }
  uint64_t flipped = 0;
  for (uint32_t i = 0; i < sides.NumParts(); ++i)
    if (!sides.is_one_sided[i]) flipped += std::min(counts[i][0], counts[i][1]);
  return flipped;
}

// Turns faces over, and sorts them anew.
absl::Status TurnOver(const std::vector<bool>& turned,
                      const CancelToken& cancel, CanonicalMesh& result) {
  std::vector<Triangle>& faces = result.mesh.faces;
  std::vector<std::pair<Triangle, uint32_t>> sorted;
  sorted.reserve(faces.size());
  MARROW_RETURN_IF_ERROR(ForEachIndex(faces.size(), cancel, [&](uint32_t f) {
    if (turned[f]) std::swap(faces[f][1], faces[f][2]);
    sorted.push_back({faces[f], f});
  }));
  // The first corner is still the least: faces with the same stay together.
  for (auto run = sorted.begin(); run != sorted.end();) {
    const auto end = std::find_if(run, sorted.end(), [&](const auto& face) {
      return face.first[0] != run->first[0];
    });
    std::sort(run, end);
    run = end;
  }
  std::vector<uint32_t> now(faces.size());
  MARROW_RETURN_IF_ERROR(ForEachIndex(sorted.size(), cancel, [&](uint32_t f) {
    faces[f] = sorted[f].first;
    now[sorted[f].second] = f;
  }));
  for (uint32_t& f : result.face_map)
    if (f != kNoIndex) f = now[f];
  return absl::OkStatus();
}

// Finds the kept face whose labels a dropped degenerate face shall have.
class NeighbourFinder {
 public:
  // Of no use once cancelled.
  NeighbourFinder(const TriangleMesh& mesh, const Spots& spots,
                  const std::vector<uint32_t>& vertex_of_spot,
                  const CancelToken& cancel)
      : spots_(spots),
        vertex_of_spot_(vertex_of_spot),
        first_face_(mesh.NumVertices(), kNoIndex) {
    for (uint32_t f = mesh.NumFaces(); f-- > 0;) {
      const auto [a, b, c] = mesh.faces[f];
      first_face_[a] = first_face_[b] = first_face_[c] = f;
      for (const auto& [v, w] : {std::pair{a, b}, {b, c}, {c, a}}) {
        sides_.push_back({std::min(v, w), std::max(v, w), f});
      }
    }
    if (SortUnlessCancelled(sides_.begin(), sides_.end(), std::less<>(), cancel)
            .ok())
      FindNearestUsed();
  }

  uint32_t FaceFor(const Triangle& degenerate) const {
    const auto [lesser, greater] =
        std::minmax({degenerate[0], degenerate[1], degenerate[2]});
    const uint32_t v = vertex_of_spot_[lesser];
    const uint32_t w = vertex_of_spot_[greater];
    if (v != kNoIndex && w != kNoIndex) {
      const auto side = std::lower_bound(sides_.begin(), sides_.end(),
                                         std::array<uint32_t, 3>{v, w, 0});
      if (side != sides_.end() && (*side)[0] == v && (*side)[1] == w) {
        return (*side)[2];
      }
    }
    if (v != kNoIndex) return first_face_[v];
    if (w != kNoIndex) return first_face_[w];
    return first_face_[vertex_of_spot_[nearest_used_[lesser]]];
  }

 private:
  // For each spot the nearer of the used spots before and after it.
  void FindNearestUsed() {
    const uint32_t count = static_cast<uint32_t>(vertex_of_spot_.size());
    nearest_used_.assign(count, kNoIndex);
    uint32_t before = kNoIndex;
    for (uint32_t s = 0; s < count; ++s) {
      if (vertex_of_spot_[s] != kNoIndex) before = s;
      nearest_used_[s] = before;
    }
    uint32_t after = kNoIndex;
    for (uint32_t s = count; s-- > 0;) {
      if (vertex_of_spot_[s] != kNoIndex) after = s;
      if (after == kNoIndex) continue;
      const uint32_t previous = nearest_used_[s];
      if (previous == kNoIndex || Distance(s, after) < Distance(s, previous)) {
        nearest_used_[s] = after;
      }
    }
  }

  double Distance(uint32_t s, uint32_t t) const {
    return (spots_.positions.row(s) - spots_.positions.row(t)).stableNorm();
  }

  const Spots& spots_;
  const std::vector<uint32_t>& vertex_of_spot_;
  std::vector<uint32_t> first_face_;
  std::vector<std::array<uint32_t, 3>> sides_;  // ends, face; sorted
  std::vector<uint32_t> nearest_used_;
};

absl::Status MapDegenerateFaces(const DecodedMesh& decoded, const Spots& spots,
                                const std::vector<uint32_t>& vertex_of_spot,
                                const CancelToken& cancel,
                                CanonicalMesh& result) {
  if (result.report.degenerate_faces == 0) return absl::OkStatus();
  const NeighbourFinder finder(result.mesh, spots, vertex_of_spot, cancel);
  return ForEachIndex(decoded.faces.size(), cancel, [&](size_t f) {
    if (result.face_map[f] != kNoIndex) return;
    result.face_map[f] = finder.FaceFor(OnSpots(decoded.faces[f], spots));
  });
}

uint64_t CountUnusedPoints(const DecodedMesh& decoded) {
  std::vector<bool> used(decoded.positions.rows(), false);
  for (const Triangle& face : decoded.faces) {
    for (uint32_t p : face) used[p] = true;
  }
  return std::count(used.begin(), used.end(), false);
}

absl::Status CheckSize(const MeshReport& report) {
  // Of the squared extent: far below what rounding leaves of any surface.
  constexpr double kLeastArea = 1e-30;
  const double extent = (report.box_max - report.box_min).maxCoeff();
  if (!std::isfinite(extent) || !std::isfinite(report.area)) {
    return Rejected(
        "the mesh is so large that its extent or area overflows; scale it "
        "down");
  }
  if (report.zero_area_faces == report.faces) {
    return Rejected(
        "the area of the mesh is zero: the corners of every face lie on a "
        "line");
  }
  if (report.area == 0) {
    return Rejected(
        "the mesh is so small that its area underflows to zero; scale it up");
  }
  if (report.area / extent / extent < kLeastArea) {
    return Rejected(
        "the area of the mesh is as good as zero against its extent: all "
        "faces are needles; check the units of its coordinates");
  }
  return absl::OkStatus();
}

// All but the maps of degenerate faces and points, and the digest.
absl::StatusOr<CanonicalMesh> Assemble(const DecodedMesh& decoded,
                                       const Spots& spots,
                                       const CancelToken& cancel,
                                       std::vector<uint32_t>& vertex_of_spot) {
  MARROW_ASSIGN_OR_RETURN(std::vector<FaceRecord> records,
                          FacesOnSpots(decoded, spots, cancel));
  if (records.empty()) {
    return Rejected(absl::StrCat(
        "all ", decoded.faces.size(),
        " faces are degenerate: each has two corners at one position; if they "
        "were rounded away, move the mesh nearer to the origin"));
  }
  CanonicalMesh result;
  result.face_map.assign(decoded.faces.size(), kNoIndex);
  std::vector<Directions> directions;
  MARROW_RETURN_IF_ERROR(KeepFaces(records, cancel, result, directions));
  result.mesh.positions = spots.positions;
  vertex_of_spot = KeepUsedVertices(result.mesh);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  Adjacency adjacency(result.mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  MARROW_ASSIGN_OR_RETURN(
      const std::vector<uint32_t> outside,
      FindInnerWalls(result.mesh, adjacency, directions, cancel));
  uint64_t inner_wall_faces = 0;
  if (!outside.empty()) {
    inner_wall_faces =
        DropInnerWalls(outside, records, result, directions, vertex_of_spot);
    adjacency = Adjacency(result.mesh, cancel);
  }
  const Sides sides = FindSides(result.mesh, adjacency, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const std::vector<bool> turned = FacesInward(result.mesh, sides, cancel);
  MARROW_RETURN_IF_ERROR(TurnOver(turned, cancel, result));
  result.report = ReportOn(result.mesh, cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  result.report.decoded_points = decoded.positions.rows();
  result.report.decoded_faces = decoded.faces.size();
  result.report.welded_points =
      decoded.positions.rows() - spots.positions.rows();
  result.report.unused_points = CountUnusedPoints(decoded);
  result.report.degenerate_faces = decoded.faces.size() - records.size();
  result.report.duplicate_faces =
      records.size() - inner_wall_faces - directions.size();
  result.report.inner_wall_faces = inner_wall_faces;
  result.report.flipped_faces = CountFlipped(directions, sides);
  MARROW_RETURN_IF_ERROR(CheckSize(result.report));
  return result;
}

// By vertex.
std::vector<uint32_t> SpotsOfVertices(
    const CanonicalMesh& mesh, const std::vector<uint32_t>& vertex_of_spot) {
  std::vector<uint32_t> spots(mesh.mesh.NumVertices());
  for (uint32_t s = 0; s < vertex_of_spot.size(); ++s)
    if (vertex_of_spot[s] != kNoIndex) spots[vertex_of_spot[s]] = s;
  return spots;
}

// How many vertices became one with another.
absl::StatusOr<uint64_t> CloseCracks(
    const CanonicalMesh& mesh, const std::vector<uint32_t>& vertex_of_spot,
    const CancelToken& cancel, Spots& spots) {
  if (mesh.report.boundary_edges == 0) return 0;
  MARROW_ASSIGN_OR_RETURN(const std::vector<uint32_t> closed,
                          FindCracks(mesh.mesh, cancel));
  uint64_t count = 0;
  for (uint32_t v = 0; v < closed.size(); ++v) count += closed[v] != v;
  if (count == 0) return 0;
  const std::vector<uint32_t> spot_of_vertex =
      SpotsOfVertices(mesh, vertex_of_spot);
  for (uint32_t& spot : spots.of_point)
    if (const uint32_t v = vertex_of_spot[spot]; v != kNoIndex)
      spot = spot_of_vertex[closed[v]];
  return count;
}

// How many vertices lie inside edges, at which those are split from now on.
absl::StatusOr<uint64_t> SplitEdges(const CanonicalMesh& mesh,
                                    const std::vector<uint32_t>& vertex_of_spot,
                                    const CancelToken& cancel, Spots& spots) {
  if (mesh.report.boundary_edges == 0) return 0;
  MARROW_ASSIGN_OR_RETURN(const TJunctions junctions,
                          FindTJunctions(mesh.mesh, cancel));
  const std::vector<uint32_t> spot_of_vertex =
      SpotsOfVertices(mesh, vertex_of_spot);
  std::vector<bool> is_inside(mesh.mesh.NumVertices(), false);
  // Vertices are in the order of their spots.
  for (const auto& [edge, inside] : junctions) {
    auto& on_spots =
        spots.junctions[{spot_of_vertex[edge[0]], spot_of_vertex[edge[1]]}];
    for (uint32_t v : inside) {
      on_spots.push_back(spot_of_vertex[v]);
      is_inside[v] = true;
    }
  }
  return std::count(is_inside.begin(), is_inside.end(), true);
}

// Assembles what has parts of faces. What is told of the payload's faces is
// what was told before.
absl::Status AssembleSplit(const DecodedMesh& decoded, const Spots& spots,
                           const CancelToken& cancel,
                           std::vector<uint32_t>& vertex_of_spot,
                           CanonicalMesh& result) {
  const MeshReport before = result.report;
  MARROW_ASSIGN_OR_RETURN(result,
                          Assemble(decoded, spots, cancel, vertex_of_spot));
  result.report.degenerate_faces = before.degenerate_faces;
  result.report.duplicate_faces = before.duplicate_faces;
  result.report.flipped_faces = before.flipped_faces;
  result.report.crack_points = before.crack_points;
  return absl::OkStatus();
}

}  // namespace

Digest GeometryDigestOf(const TriangleMesh& mesh) {
  DigestBuilder builder("marrow.geometry/2");
  builder.AddU64(mesh.NumVertices());
  builder.AddU64(mesh.NumFaces());
  builder.Add(mesh.positions.data(), mesh.positions.size() * sizeof(double));
  builder.Add(mesh.faces.data(), mesh.faces.size() * sizeof(Triangle));
  return builder.Finish();
}

absl::StatusOr<CanonicalMesh> Canonicalize(const DecodedMesh& decoded,
                                           const CancelToken& cancel) {
  if (decoded.faces.empty()) return Rejected("the mesh has no faces");
  MARROW_ASSIGN_OR_RETURN(Spots spots, Weld(decoded.positions, cancel));
  std::vector<uint32_t> vertex_of_spot;
  MARROW_ASSIGN_OR_RETURN(CanonicalMesh result,
                          Assemble(decoded, spots, cancel, vertex_of_spot));
  MARROW_ASSIGN_OR_RETURN(const uint64_t cracked,
                          CloseCracks(result, vertex_of_spot, cancel, spots));
  if (cracked > 0) {
    MARROW_ASSIGN_OR_RETURN(result,
                            Assemble(decoded, spots, cancel, vertex_of_spot));
    result.report.crack_points = cracked;
  }
  MARROW_ASSIGN_OR_RETURN(const uint64_t junctions,
                          SplitEdges(result, vertex_of_spot, cancel, spots));
  if (junctions > 0) {
    MARROW_RETURN_IF_ERROR(
        AssembleSplit(decoded, spots, cancel, vertex_of_spot, result));
    result.report.t_junctions = junctions;
  }
  MARROW_RETURN_IF_ERROR(
      MapDegenerateFaces(decoded, spots, vertex_of_spot, cancel, result));
  result.point_map.reserve(spots.of_point.size());
  for (uint32_t spot : spots.of_point)
    result.point_map.push_back(vertex_of_spot[spot]);
  result.geometry_digest = GeometryDigestOf(result.mesh);
  return result;
}

}  // namespace marrow
