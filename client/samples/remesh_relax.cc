#include <cmath>

#include "client/samples/remesh.h"
#include "client/samples/surface.h"

namespace marrow {
namespace {

// The share of the way to the neighbours' mean that a vertex goes in a round.
constexpr double kStep = 0.7;
// Two faces folded by more than this are a ridge whose edge must stay.
constexpr double kLeastFlipCosine = 0.6;

void MoveVertices(const CreatureField& field, SurfaceMesh& mesh) {
  const size_t n = mesh.positions.size();
  std::vector<Eigen::Vector3d> sum(n, Eigen::Vector3d::Zero());
  std::vector<double> weight(n, 0);
  for (const auto& face : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      sum[face[i]] += mesh.positions[face[(i + 1) % 3]];
      weight[face[i]] += 1;
    }
  }
  for (size_t v = 0; v < n; ++v) {
    const Eigen::Vector3d& p = mesh.positions[v];
    const Eigen::Vector3d normal = field.At(p).gradient.normalized();
    Eigen::Vector3d move = kStep * (sum[v] / weight[v] - p);
    move -= normal * normal.dot(move);
    mesh.positions[v] = OntoSurface(field, p + move);
  }
}

double AngleAt(const Eigen::Vector3d& apex, const Eigen::Vector3d& a,
               const Eigen::Vector3d& b) {
  const Eigen::Vector3d x = a - apex;
  const Eigen::Vector3d y = b - apex;
  return std::atan2(x.cross(y).norm(), x.dot(y));
}

class Flipper {
 public:
  explicit Flipper(SurfaceMesh& mesh)
      : mesh_(mesh), faces_of_(FacesOfVertices(mesh)) {}

  void Run() {
    for (uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      for (int i = 0; i < 3; ++i) {
        if (TryFlip(f, i)) break;
      }
    }
  }

 private:
  // The face on the other side of the edge from u to v.
  uint32_t FaceAcross(uint32_t f, uint32_t u, uint32_t v) const {
    for (uint32_t g : faces_of_[u]) {
      if (g != f && Holds(mesh_.faces[g], v)) return g;
    }
    return f;
  }

  bool AreNeighbours(uint32_t u, uint32_t v) const {
    return std::any_of(faces_of_[u].begin(), faces_of_[u].end(),
                       [&](uint32_t g) { return Holds(mesh_.faces[g], v); });
  }

  // The faces f = (u, v, a) and g = (v, u, b) become (a, u, b) and (b, v, a)
  // where that makes the angles across the edge smaller.
  bool TryFlip(uint32_t f, int corner) {
    const uint32_t u = mesh_.faces[f][corner];
    const uint32_t v = mesh_.faces[f][(corner + 1) % 3];
    const uint32_t a = mesh_.faces[f][(corner + 2) % 3];
    const uint32_t g = FaceAcross(f, u, v);
    uint32_t b = a;
    for (uint32_t w : mesh_.faces[g]) {
      if (w != u && w != v) b = w;
    }
    const auto& p = mesh_.positions;
    if (AngleAt(p[a], p[u], p[v]) + AngleAt(p[b], p[u], p[v]) <= M_PI + 1e-9) {
      return false;
    }
    if (faces_of_[u].size() <= 3 || faces_of_[v].size() <= 3) return false;
    if (AreNeighbours(a, b) || FoldsByFlip(f, g, u, v, a, b)) return false;
    mesh_.faces[f] = {a, u, b};
    mesh_.faces[g] = {b, v, a};
    std::erase(faces_of_[v], f);
    std::erase(faces_of_[u], g);
    faces_of_[b].push_back(f);
    faces_of_[a].push_back(g);
    return true;
  }

  bool FoldsByFlip(uint32_t f, uint32_t g, uint32_t u, uint32_t v, uint32_t a,
                   uint32_t b) const {
    const Eigen::Vector3d before =
        (AreaVector(mesh_.positions, mesh_.faces[f]) +
         AreaVector(mesh_.positions, mesh_.faces[g]))
            .normalized();
    const Eigen::Vector3d one = AreaVector(mesh_.positions, {a, u, b});
    const Eigen::Vector3d two = AreaVector(mesh_.positions, {b, v, a});
    return one.dot(before) <= kLeastFlipCosine * one.norm() ||
           two.dot(before) <= kLeastFlipCosine * two.norm();
  }

  SurfaceMesh& mesh_;
  std::vector<std::vector<uint32_t>> faces_of_;
};

}  // namespace

void Relax(const CreatureField& field, int rounds, SurfaceMesh& mesh) {
  for (int round = 0; round < rounds; ++round) {
    MoveVertices(field, mesh);
    Flipper(mesh).Run();
  }
}

}  // namespace marrow
