#include <algorithm>
#include <cmath>
#include <iterator>
#include <queue>
#include <tuple>

#include "absl/strings/str_cat.h"
#include "client/samples/remesh.h"
#include "client/samples/surface.h"

namespace marrow {
namespace {

// A face may turn by up to 60 degrees when an edge beside it collapses.
constexpr double kLeastNormalCosine = 0.5;

struct Candidate {
  double cost;
  uint32_t u, v;
  uint32_t version_u, version_v;

  // Ties go by index, so that the outcome is one.
  bool operator>(const Candidate& other) const {
    return std::tie(cost, u, v) > std::tie(other.cost, other.u, other.v);
  }
};

class Collapser {
 public:
  Collapser(const CreatureField& field, SurfaceMesh& mesh)
      : field_(field),
        mesh_(mesh),
        faces_of_(FacesOfVertices(mesh)),
        version_(mesh.positions.size(), 0) {
    size_.reserve(mesh.positions.size());
    for (const Eigen::Vector3d& p : mesh.positions) {
      size_.push_back(std::sqrt(field.LocalRadius(p)));
    }
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      for (uint32_t w : NeighboursOf(v)) {
        if (v < w) Push(v, w);
      }
    }
  }

  // Returns the number of faces that are left.
  size_t Run(size_t target) {
    size_t left = mesh_.faces.size();
    while (left > target && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (best.version_u != version_[best.u]) continue;
      if (best.version_v != version_[best.v]) continue;
      if (TryCollapse(best.u, best.v)) left -= 2;
    }
    return left;
  }

  void Compact() {
    std::vector<uint32_t> new_id(mesh_.positions.size());
    SurfaceMesh result;
    for (uint32_t v = 0; v < new_id.size(); ++v) {
      if (faces_of_[v].empty()) continue;
      new_id[v] = static_cast<uint32_t>(result.positions.size());
      result.positions.push_back(mesh_.positions[v]);
    }
    for (const auto& face : mesh_.faces) {
      if (face[0] == face[1]) continue;
      result.faces.push_back(
          {new_id[face[0]], new_id[face[1]], new_id[face[2]]});
    }
    mesh_ = std::move(result);
  }

 private:
  std::vector<uint32_t> NeighboursOf(uint32_t v) const {
    std::vector<uint32_t> result;
    for (uint32_t f : faces_of_[v]) {
      for (uint32_t w : mesh_.faces[f]) {
        if (w != v) result.push_back(w);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  void Push(uint32_t u, uint32_t v) {
    const double length = (mesh_.positions[u] - mesh_.positions[v]).norm();
    queue_.push(
        {length / (size_[u] + size_[v]), u, v, version_[u], version_[v]});
  }

  // On a closed surface, two common neighbours are those across the edge's
  // two faces; a third would make the collapse pinch the surface.
  bool KeepsTopology(uint32_t u, uint32_t v) const {
    const std::vector<uint32_t> of_u = NeighboursOf(u);
    const std::vector<uint32_t> of_v = NeighboursOf(v);
    std::vector<uint32_t> common;
    std::set_intersection(of_u.begin(), of_u.end(), of_v.begin(), of_v.end(),
                          std::back_inserter(common));
    if (common.size() != 2) return false;
    return std::all_of(common.begin(), common.end(),
                       [&](uint32_t w) { return faces_of_[w].size() > 3; });
  }

  // Whether moving `v` to `target` folds a face that does not hold `other`.
  bool Folds(uint32_t v, uint32_t other, const Eigen::Vector3d& target) const {
    for (uint32_t f : faces_of_[v]) {
      const auto& face = mesh_.faces[f];
      if (Holds(face, other)) continue;
      const Eigen::Vector3d before = AreaVector(mesh_.positions, face);
      std::array<Eigen::Vector3d, 3> p;
      for (int i = 0; i < 3; ++i) {
        p[i] = face[i] == v ? target : mesh_.positions[face[i]];
      }
      const Eigen::Vector3d after = (p[1] - p[0]).cross(p[2] - p[0]);
      if (after.dot(before) <=
          kLeastNormalCosine * after.norm() * before.norm()) {
        return true;
      }
    }
    return false;
  }

  bool TryCollapse(uint32_t u, uint32_t v) {
    if (!KeepsTopology(u, v)) return false;
    const Eigen::Vector3d target =
        OntoSurface(field_, 0.5 * (mesh_.positions[u] + mesh_.positions[v]));
    if (Folds(u, v, target) || Folds(v, u, target)) return false;
    Collapse(u, v);
    mesh_.positions[u] = target;
    size_[u] = 0.5 * (size_[u] + size_[v]);
    ++version_[u];
    ++version_[v];
    for (uint32_t w : NeighboursOf(u)) Push(std::min(u, w), std::max(u, w));
    return true;
  }

  // Hands the faces of v to u; the two that held both become void.
  void Collapse(uint32_t u, uint32_t v) {
    for (uint32_t f : faces_of_[v]) {
      auto& face = mesh_.faces[f];
      if (Holds(face, u)) {
        for (uint32_t w : face) {
          if (w != v) std::erase(faces_of_[w], f);
        }
        face = {0, 0, 0};
      } else {
        std::replace(face.begin(), face.end(), v, u);
        faces_of_[u].push_back(f);
      }
    }
    faces_of_[v].clear();
  }

  const CreatureField& field_;
  SurfaceMesh& mesh_;
  std::vector<std::vector<uint32_t>> faces_of_;
  std::vector<uint32_t> version_;
  std::vector<double> size_;  // the length that an edge should be, up to scale
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
};

}  // namespace

absl::Status CollapseTo(uint32_t faces, const CreatureField& field,
                        SurfaceMesh& mesh) {
  Collapser collapser(field, mesh);
  const size_t left = collapser.Run(faces);
  if (left != faces) {
    return absl::InternalError(absl::StrCat("the sample could be made with ",
                                            left, " faces, not with ", faces,
                                            "; ask for more faces"));
  }
  collapser.Compact();
  return absl::OkStatus();
}

}  // namespace marrow
