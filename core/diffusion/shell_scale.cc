#include "core/diffusion/shell_scale.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/diffusion/diffusion_map.h"
#include "core/mesh/components.h"
#include "core/operators/bridges.h"

namespace marrow {
namespace {

// A creature with one heavy prop is a large shell still, and of one that was
// cut up at its joints the trunk hardly is.
constexpr double kLargeShell = 0.3;

// A body with eyes and buttons is as good as one shell.
constexpr double kMuchSooner = 1.25;

// Modes that have less of their norm on a shell, together, tell nothing of it
// but rounding.
constexpr double kLeastMass = 1e-3;

// A row a vertex, a column a pair.
Eigen::MatrixXd Rows(const EigenPairs& pairs,
                     const std::vector<uint32_t>& vertices, uint32_t count) {
  Eigen::MatrixXd rows(vertices.size(), count);
  for (size_t i = 0; i < vertices.size(); ++i)
    rows.row(i) =
        pairs.eigenvectors.row(vertices[i]).head(count).cast<double>();
  return rows;
}

// The least eigenvalue of (A, B) but for that of the constant; 0 where there is
// none. Both are symmetric and positive semi-definite.
double LeastOf(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> masses(B);
  const auto kept = (masses.eigenvalues().array() >= kLeastMass).count();
  if (kept < 2) return 0;
  const Eigen::MatrixXd basis =
      masses.eigenvectors().rightCols(kept) *
      masses.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
             basis.transpose() * A * basis, Eigen::EigenvaluesOnly)
      .eigenvalues()[1];
}

}  // namespace

ShellScale::ShellScale(const TriangleMesh& mesh,
                       const std::vector<double>& face_areas,
                       std::span<const std::array<uint32_t, 2>> bridges) {
  DisjointSets sets(mesh.NumVertices());
  if (JoinCorners(mesh, sets) < 2) return;
  masses_.assign(mesh.NumVertices(), 0);
  std::map<uint32_t, double> areas;  // by representative
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    areas[sets.Find(mesh.faces[f][0])] += face_areas[f];
    for (uint32_t v : mesh.faces[f]) masses_[v] += face_areas[f] / 3;
  }
  std::map<uint32_t, Shell> large;
  for (const auto& [set, area] : areas)
    if (area >= kLargeShell) large[set];
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v)
    if (const auto shell = large.find(sets.Find(v)); shell != large.end())
      shell->second.vertices.push_back(v);
  for (const auto& [u, v] : bridges) {
    if (const auto shell = large.find(sets.Find(u)); shell != large.end())
      shell->second.bridges.push_back({u, v});
    if (const auto shell = large.find(sets.Find(v)); shell != large.end())
      shell->second.bridges.push_back({v, u});
  }
  for (auto& [set, shell] : large) shells_.push_back(std::move(shell));
}

double ShellScale::Slowest(const EigenPairs& pairs) const {
  const double first = pairs.eigenvalues[1];
  if (empty()) return first;
  const uint32_t count = 1 + NumPairsOfWholeClusters(pairs, kPairs);
  double slowest = first;
  for (const Shell& shell : shells_)
    slowest = std::max(slowest, SlowestOf(shell, pairs, count));
  return slowest > kMuchSooner * first ? slowest : first;
}

// The body's L phi = lambda M phi is that of the shell, and what the bridges
// take away.
double ShellScale::SlowestOf(const Shell& shell, const EigenPairs& pairs,
                             uint32_t count) const {
  const Eigen::MatrixXd rows = Rows(pairs, shell.vertices, count);
  Eigen::VectorXd masses(rows.rows());
  for (size_t i = 0; i < shell.vertices.size(); ++i)
    masses[i] = masses_[shell.vertices[i]];
  const Eigen::MatrixXd B = rows.transpose() * masses.asDiagonal() * rows;
  Eigen::MatrixXd A = B * pairs.eigenvalues.head(count).asDiagonal();
  for (const auto& [u, v] : shell.bridges) {
    const Eigen::RowVectorXd here =
        pairs.eigenvectors.row(u).head(count).cast<double>();
    const Eigen::RowVectorXd there =
        pairs.eigenvectors.row(v).head(count).cast<double>();
    A -= kBridgeWeight * here.transpose() * (here - there);
  }
  return LeastOf((A + A.transpose()) / 2, B);
}

}  // namespace marrow
