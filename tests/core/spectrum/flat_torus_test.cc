// Flat tori: parallelograms of area 1 with opposite sides glued. None of them
// is a smooth surface in space, so they are given as a triangulation is given
// to the operator once it has left space: lengths of edges, glued sides. Their
// eigenvalues are 4 pi^2 |k|^2 for all k of the dual lattice.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/operators/intrinsic_triangulation.h"
#include "core/spectrum/slicing.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using std::numbers::pi;

// Columns are the sides of the parallelogram.
using Lattice = Eigen::Matrix2d;

Lattice Square() { return Lattice::Identity(); }

// Its sides meet at 120 degrees, so that a grid's short diagonals make its
// triangles equilateral.
Lattice Hexagonal() {
  Lattice sides;
  sides << 1, -0.5, 0, std::sqrt(0.75);
  return sides / std::sqrt(std::sqrt(0.75));
}

Lattice Oblong() { return Eigen::Vector2d(1.25, 0.8).asDiagonal(); }

// `cells` by `cells` cells of two triangles; every vertex is moved by up to
// `jitter` cells.
class FlatTorus {
 public:
  FlatTorus(const Lattice& sides, int cells, double jitter)
      : sides_(sides), cells_(cells), moves_(2, cells * cells) {
    std::mt19937 random(7);
    for (double& move : moves_.reshaped())
      move = jitter * (random() / 2147483648.0 - 1);
  }

  IntrinsicTriangulation Triangulation() const {
    GluedTriangles glued;
    std::vector<IntrinsicTriangulation::Real> lengths;
    const auto add = [&](uint32_t side, uint32_t other, double length) {
      glued.mesh_edge.push_back(static_cast<uint32_t>(lengths.size()));
      glued.edges.push_back({side, other});
      lengths.push_back(length);
    };
    for (int j = 0; j < cells_; ++j)
      for (int i = 0; i < cells_; ++i) {
        for (uint32_t v : {At(i, j), At(i + 1, j), At(i + 1, j + 1), At(i, j),
                           At(i + 1, j + 1), At(i, j + 1)})
          glued.corners.push_back(v);
        const uint32_t low = 6 * At(i, j), high = low + 3;
        add(low + 2, high, Length(i, j, 1, 1));
        add(low, 6 * At(i, j - 1) + 4, Length(i, j, 1, 0));
        add(low + 1, 6 * At(i + 1, j) + 5, Length(i + 1, j, 0, 1));
      }
    return IntrinsicTriangulation(std::move(glued), lengths);
  }

  int NumVertices() const { return cells_ * cells_; }

  // Somewhere in space, for the order of elimination alone.
  Positions Places() const {
    Positions places(NumVertices(), 3);
    for (int j = 0; j < cells_; ++j)
      for (int i = 0; i < cells_; ++i) {
        const double u = 2 * pi * i / cells_, v = 2 * pi * j / cells_;
        const double w = 2 + std::cos(v);
        places.row(At(i, j)) << w * std::cos(u), w * std::sin(u), std::sin(v);
      }
    return places;
  }

 private:
  uint32_t At(int i, int j) const {
    const auto wrap = [&](int k) { return (k + cells_) % cells_; };
    return static_cast<uint32_t>(wrap(j) * cells_ + wrap(i));
  }

  // Of the edge from vertex (i, j) to the one (di, dj) further.
  double Length(int i, int j, int di, int dj) const {
    const Eigen::Vector2d step = Eigen::Vector2d(di, dj) +
                                 moves_.col(At(i + di, j + dj)) -
                                 moves_.col(At(i, j));
    return (sides_ * step).norm() / cells_;
  }

  const Lattice sides_;
  const int cells_;
  Eigen::Matrix2Xd moves_;  // in cells
};

// M^-1/2 L M^-1/2.
Eigen::SparseMatrix<double> SymmetricForm(const FlatTorus& torus) {
  IntrinsicTriangulation triangles = torus.Triangulation();
  const CancelToken cancel;
  EXPECT_TRUE(triangles.FlipToDelaunay(1'000'000, cancel).ok());
  const int n = torus.NumVertices();
  const Eigen::VectorXd areas = triangles.VertexAreas(n);
  EXPECT_NEAR(areas.sum(), 1, 1e-9);
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [ends, weight] : triangles.WeightedEdges()) {
    const auto [u, v] = ends;
    const double across = -weight / std::sqrt(areas[u] * areas[v]);
    entries.emplace_back(u, v, across);
    entries.emplace_back(v, u, across);
    entries.emplace_back(u, u, weight / areas[u]);
    entries.emplace_back(v, v, weight / areas[v]);
  }
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

class Solver {
 public:
  Solver(const FlatTorus& torus, int most_pairs)
      : most_pairs_(most_pairs),
        slicer_(*SpectrumSlicer::Create(SymmetricForm(torus),
                                        torus.Places().data(), most_pairs,
                                        SlicingOptions(), CancelToken())) {}

  // All pairs found so far, once those up to `bound` and one beyond are.
  const std::vector<double>& UpTo(double bound) {
    const CancelToken cancel;
    const auto parts =
        slicer_->Find({most_pairs_, bound}, cancel, [](double) {});
    EXPECT_TRUE(parts.ok()) << parts.status();
    for (const SpectrumPart& part : *parts)
      values_.insert(values_.end(), part.band.values.begin() + part.first,
                     part.band.values.begin() + part.end);
    return values_;
  }

 private:
  const int most_pairs_;
  const std::unique_ptr<SpectrumSlicer> slicer_;
  std::vector<double> values_;
};

// The lowest, zero included: complete up to the last one, as the lattice is
// searched far beyond.
std::vector<double> ExactEigenvalues(const Lattice& sides, size_t count) {
  const Lattice dual = sides.inverse().transpose();
  constexpr int kFar = 20;
  std::vector<double> exact;
  for (int m = -kFar; m <= kFar; ++m)
    for (int n = -kFar; n <= kFar; ++n)
      exact.push_back(4 * pi * pi *
                      (dual * Eigen::Vector2d(m, n)).squaredNorm());
  std::sort(exact.begin(), exact.end());
  exact.resize(count);
  return exact;
}

// How many there are of each value.
std::vector<int> Multiplicities(const std::vector<double>& values, size_t count,
                                double tolerance) {
  std::vector<int> multiplicities;
  for (size_t k = 0; k < count; ++k) {
    if (k == 0 || values[k] - values[k - 1] > tolerance * values[k])
      multiplicities.push_back(0);
    ++multiplicities.back();
  }
  return multiplicities;
}

// The greatest relative error of the pairs 1 to count - 1.
double WorstError(const Lattice& sides, size_t count, int cells,
                  double jitter) {
  const std::vector<double> exact = ExactEigenvalues(sides, count);
  const std::vector<double> found =
      Solver(FlatTorus(sides, cells, jitter), static_cast<int>(count))
          .UpTo(HUGE_VAL);
  EXPECT_GE(found.size(), count);
  EXPECT_NEAR(found[0], 0, 1e-6);
  double worst = 0;
  for (size_t k = 1; k < count; ++k)
    worst = std::max(worst, std::abs(found[k] / exact[k] - 1));
  return worst;
}

// Second order: edges of half the length leave a quarter of the error.
void ExpectConvergence(const Lattice& sides, size_t count, double jitter) {
  const double coarse = WorstError(sides, count, 24, jitter);
  const double fine = WorstError(sides, count, 48, jitter);
  const double finest = WorstError(sides, count, 96, jitter);
  EXPECT_LT(coarse, 0.15);
  EXPECT_LT(fine, coarse / 3);
  EXPECT_LT(finest, fine / 3);
  EXPECT_LT(finest, 0.01);  // 9,216 vertices
}

constexpr size_t kSquarePairs = 69;     // |k|^2 <= 20
constexpr size_t kHexagonalPairs = 55;  // |k|^2 <= 13 in units of the least

TEST(FlatTorusTest, Square) { ExpectConvergence(Square(), kSquarePairs, 0); }

TEST(FlatTorusTest, Hexagonal) {
  ExpectConvergence(Hexagonal(), kHexagonalPairs, 0);
}

TEST(FlatTorusTest, Oblong) { ExpectConvergence(Oblong(), 60, 0); }

TEST(FlatTorusTest, UnevenTriangles) {
  ExpectConvergence(Square(), kSquarePairs, 0.2);
}

// The grids have the symmetries of their tori, so the discrete eigenvalues are
// exactly as often there as the others.
void ExpectWhole(const Lattice& sides, size_t count,
                 const std::vector<int>& known) {
  const std::vector<double> exact = ExactEigenvalues(sides, count);
  ASSERT_EQ(Multiplicities(exact, count, 1e-9), known);
  const FlatTorus torus(sides, 40, 0);
  const std::vector<double> all = Solver(torus, 200).UpTo(HUGE_VAL);
  EXPECT_EQ(Multiplicities(all, count, 1e-6), known);
  // Whoever asks for all up to a bound, a step at a time or at once, has whole
  // ones: up to the bound and up to the end of what was found.
  Solver stepping(torus, 200);
  const std::vector<int> steps = Multiplicities(all, all.size(), 1e-6);
  size_t end = 0;
  for (size_t i = 0; end < count; ++i) {
    end += steps[i];
    const double bound = all[end - 1];
    for (const auto& found :
         {stepping.UpTo(bound), Solver(torus, 200).UpTo(bound)}) {
      ASSERT_GT(found.size(), end);
      EXPECT_GT(found[end], 1.0001 * bound);
      // What ends where all do ends as they were asked for.
      if (found.size() < all.size()) {
        EXPECT_GT(all[found.size()], 1.0001 * found.back())
            << "cut at " << found.size();
      }
    }
  }
}

TEST(FlatTorusTest, MultiplicitiesAreWhole) {
  ExpectWhole(Square(), kSquarePairs, {1, 4, 4, 4, 8, 4, 4, 8, 8, 4, 8, 4, 8});
  ExpectWhole(Hexagonal(), kHexagonalPairs, {1, 6, 6, 6, 12, 6, 6, 12});
}

}  // namespace
}  // namespace marrow
