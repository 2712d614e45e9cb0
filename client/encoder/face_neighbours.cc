#include "client/encoder/face_neighbours.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <nanoflann.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "client/segmentation.h"

namespace marrow {
namespace {

using client::kNone;

class StandInFinder {
 public:
  StandInFinder(const PolygonMesh& mesh,
                const std::vector<uint32_t>& site_of_vertex,
                const std::vector<bool>& labelled);

  // kNone where no labelled face touches face f.
  uint32_t Touching(size_t f) const;

 private:
  using FaceRange = std::span<const std::pair<uint32_t, uint32_t>>;

  uint32_t Site(uint32_t vertex) const { return site_of_vertex_[vertex]; }
  FaceRange FacesAt(uint32_t site) const;
  bool Uses(uint32_t face, uint32_t site) const;
  uint32_t SharingEdge(uint32_t a, uint32_t b) const;

  const PolygonMesh& mesh_;
  const std::vector<uint32_t>& site_of_vertex_;
  // (site, labelled face) in order, for the sites of faces without a label.
  std::vector<std::pair<uint32_t, uint32_t>> incidence_;
};

StandInFinder::StandInFinder(const PolygonMesh& mesh,
                             const std::vector<uint32_t>& site_of_vertex,
                             const std::vector<bool>& labelled)
    : mesh_(mesh), site_of_vertex_(site_of_vertex) {
  std::vector<bool> wanted(site_of_vertex.size(), false);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    if (labelled[f]) continue;
    for (const uint32_t v : mesh.Face(f)) wanted[Site(v)] = true;
  }
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    if (!labelled[f]) continue;
    for (const uint32_t v : mesh.Face(f)) {
      if (wanted[Site(v)]) incidence_.emplace_back(Site(v), f);
    }
  }
  std::sort(incidence_.begin(), incidence_.end());
}

StandInFinder::FaceRange StandInFinder::FacesAt(uint32_t site) const {
  const auto begin = std::lower_bound(incidence_.begin(), incidence_.end(),
                                      std::make_pair(site, 0u));
  const auto end =
      std::upper_bound(begin, incidence_.end(), std::make_pair(site, kNone));
  return FaceRange(begin, end);
}

bool StandInFinder::Uses(uint32_t face, uint32_t site) const {
  const std::span<const uint32_t> corners = mesh_.Face(face);
  return std::any_of(corners.begin(), corners.end(),
                     [&](uint32_t v) { return Site(v) == site; });
}

uint32_t StandInFinder::SharingEdge(uint32_t a, uint32_t b) const {
  FaceRange faces = FacesAt(a);
  const FaceRange others = FacesAt(b);
  uint32_t wanted = b;
  if (others.size() < faces.size()) {
    faces = others;
    wanted = a;
  }
  for (const auto& [site, face] : faces) {
    if (Uses(face, wanted)) return face;
  }
  return kNone;
}

uint32_t StandInFinder::Touching(size_t f) const {
  const std::span<const uint32_t> corners = mesh_.Face(f);
  uint32_t best = kNone;
  for (size_t i = 0; i < corners.size(); ++i) {
    const uint32_t a = Site(corners[i]);
    const uint32_t b = Site(corners[(i + 1) % corners.size()]);
    if (a != b) best = std::min(best, SharingEdge(a, b));
  }
  if (best != kNone) return best;
  for (const uint32_t v : corners) {
    const FaceRange faces = FacesAt(Site(v));
    if (!faces.empty()) best = std::min(best, faces.front().second);
  }
  return best;
}

using Centres = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The origin for a face without corners or with one that is not finite, which
// the search tree could not hold.
Eigen::RowVector3d Centre(const PolygonMesh& mesh, size_t f) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (const uint32_t v : mesh.Face(f)) {
    sum += Eigen::Map<const Eigen::RowVector3d>(mesh.positions[v].data());
  }
  if (!mesh.Face(f).empty()) sum /= static_cast<double>(mesh.Face(f).size());
  return sum.allFinite() ? sum : Eigen::RowVector3d::Zero();
}

void FindNearest(const PolygonMesh& mesh, const std::vector<bool>& labelled,
                 std::vector<uint32_t>* stand_ins) {
  std::vector<uint32_t> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    if (labelled[f]) faces.push_back(f);
  }
  Centres centres(faces.size(), 3);
  for (size_t i = 0; i < faces.size(); ++i) {
    centres.row(static_cast<Eigen::Index>(i)) = Centre(mesh, faces[i]);
  }
  using Tree = nanoflann::KDTreeEigenMatrixAdaptor<Centres, 3>;
  const Tree tree(3, std::cref(centres));
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    if ((*stand_ins)[f] != kNone) continue;
    const Eigen::RowVector3d centre = Centre(mesh, f);
    Eigen::Index nearest = 0;
    double squared_distance = 0;
    tree.index->knnSearch(centre.data(), 1, &nearest, &squared_distance);
    (*stand_ins)[f] = faces[static_cast<size_t>(nearest)];
  }
}

}  // namespace

std::vector<uint32_t> FindStandIns(const PolygonMesh& mesh,
                                   const std::vector<uint32_t>& site_of_vertex,
                                   const std::vector<bool>& labelled) {
  std::vector<uint32_t> stand_ins(mesh.NumFaces());
  std::iota(stand_ins.begin(), stand_ins.end(), 0u);
  if (std::find(labelled.begin(), labelled.end(), false) == labelled.end()) {
    return stand_ins;
  }
  const StandInFinder finder(mesh, site_of_vertex, labelled);
  bool some_apart = false;
  for (size_t f = 0; f < stand_ins.size(); ++f) {
    if (labelled[f]) continue;
    stand_ins[f] = finder.Touching(f);
    some_apart |= stand_ins[f] == kNone;
  }
  if (some_apart) FindNearest(mesh, labelled, &stand_ins);
  return stand_ins;
}

}  // namespace marrow
