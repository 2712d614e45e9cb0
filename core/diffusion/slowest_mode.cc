#include "core/diffusion/slowest_mode.h"

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

// A mode is a spike's if its participation ratio is less than this: that of one
// that is even on such a share of the area, and zero elsewhere. Of the limbs of
// real creatures a tentacle of an octopus comes nearest, with .08, and its next
// mode is 1.1 times as fast; one vertex pulled out by a diagonal has .03
// and 4.3.
constexpr double kSpread = 0.1;
constexpr double kMuchFaster = 2;

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

SlowestMode::SlowestMode(const TriangleMesh& mesh,
                         const std::vector<double>& face_areas,
                         std::span<const std::array<uint32_t, 2>> bridges) {
  masses_.assign(mesh.NumVertices(), 0);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    for (uint32_t v : mesh.faces[f]) masses_[v] += face_areas[f] / 3;
  DisjointSets sets(mesh.NumVertices());
  if (JoinCorners(mesh, sets) < 2) return;
  std::map<uint32_t, double> areas;  // by representative
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    areas[sets.Find(mesh.faces[f][0])] += face_areas[f];
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

bool SlowestMode::IsKnownFrom(const EigenPairs& pairs) const {
  // One more than are made use of tells whether the last is one of a cluster.
  if (pairs.NumPairs() >= kPairs + 2) return true;
  return shells_.empty() && FirstSpread(pairs) > 0;
}

// By the participation ratio, (int phi^2)^2 / int phi^4, for area 1.
bool SlowestMode::IsSpread(const EigenPairs& pairs, uint32_t pair) const {
  double squares = 0, fourth_powers = 0;
  for (size_t v = 0; v < masses_.size(); ++v) {
    const double phi = pairs.eigenvectors(v, pair);
    squares += masses_[v] * phi * phi;
    fourth_powers += masses_[v] * phi * phi * phi * phi;
  }
  return squares * squares >= kSpread * fourth_powers;
}

uint32_t SlowestMode::FirstSpread(const EigenPairs& pairs) const {
  for (uint32_t pair = 1; pair < std::min(pairs.NumPairs(), 1 + kPairs); ++pair)
    if (IsSpread(pairs, pair)) return pair;
  return 0;
}

double SlowestMode::Of(const EigenPairs& pairs) const {
  const double first = pairs.eigenvalues[1];
  const double spread = pairs.eigenvalues[FirstSpread(pairs)];
  const double slowest = spread > kMuchFaster * first ? spread : first;
  if (shells_.empty()) return slowest;
  const uint32_t count = 1 + NumPairsOfWholeClusters(pairs, kPairs);
  double of_shells = 0;
  for (const Shell& shell : shells_)
    of_shells = std::max(of_shells, FirstOf(shell, pairs, count));
  return of_shells > kMuchSooner * first ? std::max(of_shells, slowest)
                                         : slowest;
}

// The body's L phi = lambda M phi is that of the shell, and what the bridges
// take away.
double SlowestMode::FirstOf(const Shell& shell, const EigenPairs& pairs,
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
