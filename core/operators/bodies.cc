#include "core/operators/bodies.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/status_macros.h"
#include "core/mesh/components.h"
#include "core/mesh/face_areas.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/patches.h"
#include "core/mesh/submesh.h"
#include "core/mesh/touching_shells.h"
#include "core/operators/attachment.h"
#include "core/operators/laplacian.h"
#include "core/operators/scenery.h"

namespace marrow {
namespace {

using Groups = std::vector<std::vector<uint32_t>>;

// Members of 0 .. n-1 by their group. Groups are in the order of their least
// members, members ascending.
Groups GroupBy(uint32_t n, DisjointSets& sets) {
  std::vector<uint32_t> place(n, kNoIndex);
  Groups groups;
  for (uint32_t i = 0; i < n; ++i) {
    uint32_t& at = place[sets.Find(i)];
    if (at == kNoIndex) {
      at = static_cast<uint32_t>(groups.size());
      groups.emplace_back();
    }
    groups[at].push_back(i);
  }
  return groups;
}

// Parts sorted out of the mesh, each a set of faces with its area.
struct Part {
  std::vector<uint32_t> faces;  // ascending
  double share = 0;
  double weight = 0;  // the share of all that it shares vertices with
  uint32_t components = 1;
  bool is_worn = false;
};

void LargestFirst(std::vector<Part>& parts) {
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.share != b.share ? a.share > b.share
                              : a.faces.front() < b.faces.front();
  });
}

// Takes the parts from place `first` on out of `from`.
std::vector<Part> Split(std::vector<Part>& from, size_t first) {
  std::vector<Part> rest(std::make_move_iterator(from.begin() + first),
                         std::make_move_iterator(from.end()));
  from.resize(first);
  return rest;
}

// The components, each kind largest first. The shares of `parts` are in the
// area of what is not scenery, those of `scenery` in that of the mesh.
void PartsOf(const TriangleMesh& mesh, const CancelToken& cancel,
             std::vector<Part>& parts, std::vector<Part>& scenery) {
  const std::vector<double> areas = FaceAreaShares(mesh);
  Groups components = FacesByComponent(mesh);
  const std::vector<bool> is_scenery = FindScenery(mesh, components, cancel);
  double sum = 0;
  for (size_t i = 0; i < components.size(); ++i) {
    Part& part = (is_scenery[i] ? scenery : parts).emplace_back();
    part.share = AreaOf(components[i], areas);
    part.faces = std::move(components[i]);
    if (!is_scenery[i]) sum += part.share;
  }
  if (sum > 0)
    for (Part& part : parts) part.share /= sum;
  else  // Nothing is there that it could be the scenery of.
    for (Part& part : Split(scenery, 0)) parts.push_back(std::move(part));
  for (Part& part : parts) part.weight = part.share;
  LargestFirst(parts);
  LargestFirst(scenery);
}

// Shells that were parted weigh as much as they did as one component, which
// they stay beside. `whole` is the mesh before, with the same faces.
void WeighTogether(const TriangleMesh& whole, std::vector<Part>& parts) {
  DisjointSets vertices(whole.NumVertices());
  JoinCorners(whole, vertices);
  std::vector<double> weight(whole.NumVertices(), 0);
  const auto component = [&](const Part& part) {
    return vertices.Find(whole.faces[part.faces.front()][0]);
  };
  for (const Part& part : parts) weight[component(part)] += part.share;
  for (Part& part : parts) part.weight = weight[component(part)];
  std::ranges::stable_sort(parts, std::ranges::greater(), &Part::weight);
}

// Open is what has at most so many faces an edge of its rim.
constexpr uint64_t kFacesOfRimEdge = 3;

// Joining more takes longer than an answer may.
constexpr size_t kMostShreds = 250'000;

// Of rule 2.
bool AreShreds(const std::vector<Part>& parts, const MeshReport& report) {
  const auto is_main = [](const Part& part) {
    return part.weight >= kMainShare;
  };
  return parts.size() >= kFewestShreds && parts.size() <= kMostShreds &&
         std::ranges::none_of(parts, is_main) &&
         report.faces <= kFacesOfShred * report.components &&
         kFacesOfRimEdge * report.boundary_edges >= report.faces;
}

// Rule 1. REQUIRES: heaviest first. The number of components of weight.
size_t CountOfWeight(const std::vector<Part>& parts) {
  auto count_from = [&](double share) {
    size_t count = 1;
    while (count < parts.size() && parts[count].weight >= share) ++count;
    return count;
  };
  const size_t heavy = count_from(
      std::clamp(kBodyShare * parts[0].weight, kLightWeight, kWeight));
  double sum = 0;
  for (size_t i = 0; i < heavy; ++i) sum += parts[i].share;
  return sum >= kMainShare ? heavy : count_from(kLightWeight);
}

std::vector<uint32_t> AllFacesOf(const std::vector<Part>& parts) {
  std::vector<uint32_t> faces;
  for (const Part& part : parts)
    faces.insert(faces.end(), part.faces.begin(), part.faces.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

double BoxDiagonal(const TriangleMesh& mesh,
                   const std::vector<uint32_t>& faces) {
  Eigen::RowVector3d low = mesh.positions.row(mesh.faces[faces[0]][0]);
  Eigen::RowVector3d high = low;
  for (uint32_t f : faces) {
    for (uint32_t v : mesh.faces[f]) {
      low = low.cwiseMin(mesh.positions.row(v));
      high = high.cwiseMax(mesh.positions.row(v));
    }
  }
  return (high - low).stableNorm();
}

// Of rule 2. `main` is made of the parts.
double NearDistance(const TriangleMesh& mesh, const std::vector<Part>& parts,
                    const Submesh& main, bool are_shreds) {
  double widest = 0, sum = 0;
  for (const Part& part : parts) {
    const double breadth = BoxDiagonal(mesh, part.faces);
    widest = std::max(widest, breadth);
    sum += breadth / static_cast<double>(parts.size());
  }
  return std::min(BridgingDistance(main.canonical.mesh),
                  are_shreds ? kShredGap * sum : kBridgedGap * widest);
}

// How many groups of parts bridges within the distance leave. `main` is made of
// the parts.
size_t CountGroups(const std::vector<Part>& parts, const Submesh& main,
                   double distance, const CancelToken& cancel) {
  return parts.size() -
         SpanningBridges(main.canonical.mesh, distance, cancel).size();
}

// Takes out of the parts of weight those that are worn, unless they hold others
// together.
absl::StatusOr<std::vector<Part>> TakeWorn(const TriangleMesh& mesh,
                                           const CancelToken& cancel,
                                           std::vector<Part>& parts) {
  std::vector<Part> worn, left;
  if (parts.size() == 1) return worn;
  LargestFirst(parts);
  const Submesh main = ExtractFaces(mesh, AllFacesOf(parts), cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const std::vector<uint32_t> all = AllFacesOf(parts);
  Groups faces;  // of main
  for (const Part& part : parts) {
    std::vector<uint32_t>& own = faces.emplace_back();
    for (uint32_t f : part.faces)
      own.push_back(static_cast<uint32_t>(
          std::lower_bound(all.begin(), all.end(), f) - all.begin()));
  }
  const double distance = NearDistance(mesh, parts, main, false);
  MARROW_ASSIGN_OR_RETURN(
      const std::vector<bool> is_worn,
      FindWorn(main.canonical.mesh, faces, distance, cancel));
  if (std::ranges::find(is_worn, true) == is_worn.end()) return worn;
  const size_t groups = CountGroups(parts, main, distance, cancel);
  for (size_t p = 0; p < parts.size(); ++p) {
    parts[p].is_worn = is_worn[p];
    (is_worn[p] ? worn : left).push_back(std::move(parts[p]));
  }
  const Submesh rest = ExtractFaces(mesh, AllFacesOf(left), cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  if (CountGroups(left, rest, distance, cancel) <= groups) {
    parts = std::move(left);
    return worn;
  }
  for (Part& part : worn) {
    part.is_worn = false;
    left.push_back(std::move(part));
  }
  parts = std::move(left);
  LargestFirst(parts);
  return std::vector<Part>();
}

// Rule 2: joins the parts that bridges within the distance connect.
absl::StatusOr<std::vector<Part>> JoinNear(const TriangleMesh& mesh,
                                           std::vector<Part> parts,
                                           bool are_shreds,
                                           const CancelToken& cancel,
                                           double& distance) {
  const Submesh main = ExtractFaces(mesh, AllFacesOf(parts), cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  distance = NearDistance(mesh, parts, main, are_shreds);
  std::vector<uint32_t> part_of_vertex(mesh.NumVertices(), kNoIndex);
  for (uint32_t p = 0; p < parts.size(); ++p)
    for (uint32_t f : parts[p].faces)
      for (uint32_t v : mesh.faces[f]) part_of_vertex[v] = p;
  DisjointSets sets(static_cast<uint32_t>(parts.size()));
  for (const auto& [u, v] :
       SpanningBridges(main.canonical.mesh, distance, cancel))
    sets.Union(part_of_vertex[main.vertices[u]],
               part_of_vertex[main.vertices[v]]);
  std::vector<Part> joined;
  for (const auto& group : GroupBy(static_cast<uint32_t>(parts.size()), sets)) {
    Part& body = joined.emplace_back(std::move(parts[group[0]]));
    for (size_t i = 1; i < group.size(); ++i) {
      const Part& part = parts[group[i]];
      body.faces.insert(body.faces.end(), part.faces.begin(), part.faces.end());
      body.share += part.share;
      ++body.components;
    }
    std::sort(body.faces.begin(), body.faces.end());
    MARROW_RETURN_IF_ERROR(cancel.Check());
  }
  return joined;
}

// Rule 3. REQUIRES: largest first.
size_t CountBodies(const std::vector<Part>& parts) {
  size_t count = 1;
  while (count < parts.size() && count < kMaxBodies &&
         parts[count].share >= kBodyShare * parts[0].share)
    ++count;
  return count;
}

std::vector<uint32_t> Iota(uint32_t n) {
  std::vector<uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// Refers to the mesh instead of copying it.
Body WholeBody(const CanonicalMesh& mesh, const CancelToken& cancel) {
  Body body;
  body.canonical = std::shared_ptr<const CanonicalMesh>(
      std::shared_ptr<const CanonicalMesh>(), &mesh);
  body.faces = Iota(mesh.mesh.NumFaces());
  body.vertices = Iota(mesh.mesh.NumVertices());
  body.bridges = FindBridges(mesh.mesh, cancel);
  return body;
}

// Rule 6.
absl::Status Patch(const CancelToken& cancel, Bodies& bodies) {
  for (Body& body : bodies.bodies) {
    if (body.canonical->report.boundary_edges == 0) continue;
    MARROW_ASSIGN_OR_RETURN(const std::vector<Triangle> patches,
                            PatchHoles(body.canonical->mesh, cancel));
    const uint32_t faces = body.canonical->mesh.NumFaces();
    if (patches.empty() ||
        static_cast<double>(patches.size()) < kSievePatches * faces)
      continue;
    auto patched = std::make_shared<CanonicalMesh>();
    patched->mesh = body.canonical->mesh;
    patched->mesh.faces.insert(patched->mesh.faces.end(), patches.begin(),
                               patches.end());
    patched->report = ReportOn(patched->mesh, cancel);
    patched->geometry_digest = GeometryDigestOf(patched->mesh);
    body.patched = std::move(patched);
  }
  return cancel.Check();
}

// Rule 7, noted in the report.
void CoarsenLarge(const CancelToken& cancel, Bodies& bodies,
                  MeshReport& report) {
  report.coarse_vertices = 0;
  for (Body& body : bodies.bodies) {
    const TriangleMesh& mesh = body.Patched().mesh;
    if (mesh.NumVertices() <= kLargeBody) continue;
    CoarseMesh coarse = Coarsen(mesh, kCoarseVertices, cancel);
    if (cancel.IsCancelled()) return;
    const uint32_t left = coarse.canonical.mesh.NumVertices();
    if (left > mesh.NumVertices() / 2) continue;
    body.coarse = std::make_shared<const CoarseMesh>(std::move(coarse));
    report.coarse_vertices += left;
    report.body_vertices -= mesh.NumVertices() - left;
  }
}

void Note(const std::vector<Part>& bodies, const std::vector<Part>& attached,
          double distance, MeshReport& report) {
  report.bodies = bodies.size();
  report.bridging_distance = distance;
  report.bridged_components = 0;
  report.attached_components = 0;
  report.attached_faces = 0;
  report.worn_components = 0;
  for (const Part& part : bodies)
    report.bridged_components += part.components > 1 ? part.components : 0;
  for (const Part& part : attached) {
    (part.is_worn ? report.worn_components : report.attached_components) +=
        part.components;
    report.attached_faces += part.faces.size();
  }
}

// Rule 4, to the first `count` bodies: the others are scenery. `near` is the
// bridging distance.
absl::Status AttachRest(const TriangleMesh& mesh, std::vector<Part>& attached,
                        size_t count, double near, const CancelToken& cancel,
                        Bodies& bodies) {
  std::vector<uint32_t> faces;
  for (size_t b = 0; b < count; ++b)
    faces.insert(faces.end(), bodies.bodies[b].faces.begin(),
                 bodies.bodies[b].faces.end());
  std::vector<Attachment> attachments;
  attachments.reserve(attached.size());
  for (Part& part : attached)
    attachments.push_back({std::move(part.faces), part.is_worn});
  return Attach(mesh, std::move(faces), attachments, near, cancel,
                bodies.anchors);
}

// Back from the parted mesh.
void TakeWholeVertices(const std::vector<uint32_t>& whole, Body& body) {
  body.is_parted = true;
  for (uint32_t& v : body.vertices) v = whole[v];
  for (auto& [one, other] : body.seams) {
    one = whole[one];
    other = whole[other];
  }
}

// Rules 1 to 5.
absl::StatusOr<Bodies> SortOut(CanonicalMesh& mesh, const CancelToken& cancel) {
  Bodies result;
  result.anchors = Iota(mesh.mesh.NumFaces());
  PartedMesh parted;
  if (mesh.report.nonmanifold_vertices > 0)
    parted = PartTouchingShells(mesh.mesh, FaceAreaShares(mesh.mesh), kWeight,
                                cancel);
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const bool is_parted = !parted.vertices.empty();
  const TriangleMesh& shells = is_parted ? parted.mesh : mesh.mesh;
  if (mesh.report.components == 1 && !is_parted) {
    mesh.report.bodies = 1;
    mesh.report.body_vertices = mesh.mesh.NumVertices();
    result.bodies.push_back(WholeBody(mesh, cancel));
    return result;
  }
  std::vector<Part> parts, scenery;
  PartsOf(shells, cancel, parts, scenery);
  if (is_parted) WeighTogether(mesh.mesh, parts);
  const bool are_shreds = AreShreds(parts, mesh.report);
  std::vector<Part> attached =
      Split(parts, are_shreds ? parts.size() : CountOfWeight(parts));
  double distance = 0;
  MARROW_RETURN_IF_ERROR(cancel.Check());
  if (!are_shreds) {
    MARROW_ASSIGN_OR_RETURN(std::vector<Part> worn,
                            TakeWorn(shells, cancel, parts));
    std::move(worn.begin(), worn.end(), std::back_inserter(attached));
  }
  MARROW_ASSIGN_OR_RETURN(
      parts, JoinNear(shells, std::move(parts), are_shreds, cancel, distance));
  LargestFirst(parts);
  for (Part& part : Split(parts, CountBodies(parts)))
    attached.push_back(std::move(part));
  const size_t count = parts.size();
  for (Part& part : scenery) {
    part.share = kSceneryShare * parts[0].share;
    parts.push_back(std::move(part));
  }
  Note(parts, attached, distance, mesh.report);

  if (parts.size() == 1 && attached.empty() && parts[0].components == 1 &&
      !is_parted) {
    result.bodies.push_back(WholeBody(mesh, cancel));
  } else {
    for (Part& part : parts) {
      MARROW_ASSIGN_OR_RETURN(
          Body body, MakeBody(shells, std::move(part.faces),
                              part.components > 1, are_shreds, cancel));
      body.share = part.share;
      result.bodies.push_back(std::move(body));
    }
    MARROW_RETURN_IF_ERROR(
        AttachRest(shells, attached, count, distance, cancel, result));
  }
  if (is_parted)
    for (Body& body : result.bodies) TakeWholeVertices(parted.vertices, body);
  mesh.report.bridges = mesh.report.body_vertices = 0;
  double sum = 0;
  for (const Body& body : result.bodies) {
    mesh.report.bridges += body.bridges.size();
    mesh.report.body_vertices += body.vertices.size();
    sum += body.share;
  }
  for (Body& body : result.bodies) body.share /= sum;
  return result;
}

}  // namespace

Bodies FindBodies(CanonicalMesh& mesh, const CancelToken& cancel) {
  absl::StatusOr<Bodies> result = SortOut(mesh, cancel);
  if (!result.ok() || !Patch(cancel, *result).ok()) return {};
  CoarsenLarge(cancel, *result, mesh.report);
  return *std::move(result);
}

}  // namespace marrow
