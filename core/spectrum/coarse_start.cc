// Why something so crude will do: what is rough in a start vector, one solve
// with the shifted matrix damps by a factor of hundreds. What remains is how
// much of the neighbouring eigenvectors is mixed in, and that depends on the
// coarse operator alone. A finite-volume scheme on Voronoi cells gets its
// eigenvalues right to some per cent, and needs no interpolation.
#include "core/spectrum/coarse_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "core/spectrum/dense_kernels.h"

namespace marrow {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Visit = std::pair<double, int>;
using Queue = std::priority_queue<Visit, std::vector<Visit>, std::greater<>>;

double Distance(const double* positions, int a, int b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = positions[3L * a + i] - positions[3L * b + i];
    sum += d * d;
  }
  return std::sqrt(sum);
}

// Seeds no two of which are within `reach` edges: the vertices in the order of
// their numbers, each unless one near is a seed already.
std::vector<int> SpreadSeeds(const Sparse& matrix, double wanted_mass,
                             const std::vector<double>& mass) {
  const int n = static_cast<int>(matrix.rows());
  std::vector<char> taken(n, 0);
  std::vector<int> seeds, ball;
  for (int v = 0; v < n; ++v) {
    if (taken[v]) continue;
    seeds.push_back(v);
    // Takes the nearest vertices in the graph until they have the mass.
    ball.assign(1, v);
    taken[v] = 1;
    double sum = mass[v];
    for (size_t read = 0; read < ball.size() && sum < wanted_mass; ++read)
      for (Sparse::InnerIterator it(matrix, ball[read]);
           it && sum < wanted_mass; ++it) {
        const int u = static_cast<int>(it.row());
        if (taken[u]) continue;
        taken[u] = 1;
        ball.push_back(u);
        sum += mass[u];
      }
    // The seed is better off amid what it took than where it began.
    seeds.back() = ball[ball.size() / 2];
  }
  return seeds;
}

// Distances along edges from the nearest seed, and whose cell one is in.
void GrowCells(const Sparse& matrix, const double* positions,
               const std::vector<int>& seeds, std::vector<int>& cell,
               std::vector<double>& distance) {
  const int n = static_cast<int>(matrix.rows());
  cell.assign(n, -1);
  distance.assign(n, std::numeric_limits<double>::infinity());
  Queue queue;
  for (size_t s = 0; s < seeds.size(); ++s) {
    distance[seeds[s]] = 0;
    cell[seeds[s]] = static_cast<int>(s);
    queue.push({0, seeds[s]});
  }
  while (!queue.empty()) {
    const auto [at, v] = queue.top();
    queue.pop();
    if (at > distance[v]) continue;
    for (Sparse::InnerIterator it(matrix, v); it; ++it) {
      const int u = static_cast<int>(it.row());
      const double there = at + Distance(positions, u, v);
      if (there >= distance[u]) continue;
      distance[u] = there;
      cell[u] = cell[v];
      queue.push({there, u});
    }
  }
}

}  // namespace

CoarseProblem MakeCoarseProblem(const Sparse& matrix,
                                const Eigen::VectorXd& inverse_sqrt_mass,
                                const double* positions, int cells) {
  const int n = static_cast<int>(matrix.rows());
  std::vector<double> mass(n);
  for (int v = 0; v < n; ++v)
    mass[v] = 1 / (inverse_sqrt_mass[v] * inverse_sqrt_mass[v]);
  CoarseProblem coarse;
  const std::vector<int> seeds = SpreadSeeds(matrix, 1.0 / cells, mass);
  std::vector<double> distance;
  GrowCells(matrix, positions, seeds, coarse.cell, distance);

  const int count = static_cast<int>(seeds.size());
  coarse.sqrt_mass.assign(count, 0.0);
  for (int v = 0; v < n; ++v) coarse.sqrt_mass[coarse.cell[v]] += mass[v];
  for (double& m : coarse.sqrt_mass) m = std::sqrt(m);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int v = 0; v < n; ++v)
    for (Sparse::InnerIterator it(matrix, v); it; ++it) {
      const int u = static_cast<int>(it.row());
      const int a = coarse.cell[v], b = coarse.cell[u];
      if (a == b) continue;
      const double edge = Distance(positions, u, v);
      const double way = distance[v] + edge + distance[u];
      const double weight = -it.value() /
                            (inverse_sqrt_mass[u] * inverse_sqrt_mass[v]) *
                            (way > 0 ? edge / way : 1);
      if (!(weight > 0)) continue;
      const double sa = coarse.sqrt_mass[a], sb = coarse.sqrt_mass[b];
      triplets.emplace_back(a, a, weight / (sa * sa));
      triplets.emplace_back(b, a, -weight / (sa * sb));
    }
  for (int a = 0; a < count; ++a) triplets.emplace_back(a, a, 0.0);
  coarse.matrix.resize(count, count);
  coarse.matrix.setFromTriplets(triplets.begin(), triplets.end());
  for (int s : seeds)
    for (int i = 0; i < 3; ++i)
      coarse.positions.push_back(positions[3L * s + i]);
  return coarse;
}

void CoarseStart::Fill(int first, double* X) const {
  const int width = std::min(kBlock, count - first);
  const int n = static_cast<int>(cell.size());
  for (int i = 0; i < n; ++i) {
    const float* row = values.data() + static_cast<size_t>(cell[i]) * count;
    for (int c = 0; c < width; ++c)
      X[static_cast<size_t>(i) * kBlock + c] = sqrt_mass[i] * row[first + c];
  }
}

}  // namespace marrow
