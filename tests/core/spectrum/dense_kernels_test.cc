#include "core/spectrum/dense_kernels.h"

#include <Eigen/Core>
#include <vector>

#include "gtest/gtest.h"

namespace marrow {
namespace {

using Rows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// All kernels that this CPU can run, on sizes about those of tiles.
template <typename Check>
void ForKernels(const Check& check) {
  for (const DenseKernels* const* it = AllKernels(); *it != nullptr; ++it)
    for (int m : {1, 3, 4, 7, 8, 9, 16, 21})
      for (int k : {1, 2, 4, 5, 8, 13, 64}) {
        SCOPED_TRACE(testing::Message()
                     << (*it)->name << ", " << m << " x " << k);
        srand(m * 100 + k);
        check(**it, m, k);
      }
}

void ExpectSame(const Rows& found, const Rows& exact) {
  EXPECT_LT((found - exact).cwiseAbs().maxCoeff(), 1e-13);
}

std::vector<double> InTiles(const Rows& P) {
  std::vector<double> tiles;
  for (int i = 0; i < P.rows(); i += kTile)
    for (int l = 0; l < P.cols(); ++l)
      for (int r = i; r < i + kTile; ++r)
        tiles.push_back(r < P.rows() ? P(r, l) : 0);
  EXPECT_EQ(tiles.size(), TilesSize(P.rows(), P.cols()));
  return tiles;
}

std::vector<double> TriangleInTiles(const Rows& T) {
  std::vector<double> tiles;
  const int k = static_cast<int>(T.rows());
  for (int i = (k - 1) / kTile * kTile; i >= 0; i -= kTile)
    for (int l = 0; l < TriangleTileColumns(k, i); ++l)
      for (int r = i; r < i + kTile; ++r) tiles.push_back(r < k ? T(r, l) : 0);
  EXPECT_EQ(tiles.size(), TriangleSize(k));
  return tiles;
}

TEST(DenseKernelsTest, Products) {
  ForKernels([](const DenseKernels& kernels, int m, int k) {
    const Rows A = Rows::Random(m, k), B = Rows::Random(k, 3 * kPad);
    const Rows C = Rows::Random(m, 3 * kPad);
    Rows sum = C, rest = C;
    const int n = static_cast<int>(C.cols());
    kernels.multiply_add(m, n, k, {A.data(), k, 1}, B.data(), n, sum.data(), n);
    kernels.multiply_subtract(m, n, k, {A.data(), k, 1}, B.data(), n,
                              rest.data(), n);
    ExpectSame(sum, C + A * B);
    ExpectSame(rest, C - A * B);
  });
}

TEST(DenseKernelsTest, SumsOfBlocks) {
  ForKernels([](const DenseKernels& kernels, int m, int count) {
    // Rows before those that count are not to be read.
    const int before = 2;
    std::vector<Rows> A;
    std::vector<const double*> pointers;
    const Rows B = Rows::Random(count * kBlock, 2 * kBlock);
    const Rows C = Rows::Random(m, kBlock);
    Rows sum = C, rest = C, product = Rows::Zero(m, kBlock);
    for (int j = 0; j < count; ++j) {
      A.push_back(Rows::Random(before + m, kBlock));
      product += A[j].bottomRows(m) * B.block(j * kBlock, 0, kBlock, kBlock);
    }
    for (const Rows& block : A) pointers.push_back(block.data());
    kernels.blocks_add(m, count, pointers.data(), before * kBlock, B.data(),
                       2 * kBlock, sum.data());
    kernels.blocks_subtract(m, count, pointers.data(), before * kBlock,
                            B.data(), 2 * kBlock, rest.data());
    ExpectSame(sum, C + product);
    ExpectSame(rest, C - product);
  });
}

TEST(DenseKernelsTest, SparseRows) {
  ForKernels([](const DenseKernels& kernels, int n, int) {
    Rows A = Rows::Zero(n, n);
    std::vector<size_t> start = {0};
    std::vector<int> columns;
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
      for (int j = i % 3; j < n; j += 2 + i % 2) {
        columns.push_back(j);
        values.push_back(1 + 0.1 * i - 0.3 * j);
        A(i, j) = values.back();
      }
      start.push_back(columns.size());
    }
    const Rows X = Rows::Random(n, kBlock), Y = Rows::Random(n, kBlock);
    Rows rest = Y;
    kernels.sparse_subtract(n, start.data(), columns.data(), values.data(),
                            X.data(), rest.data());
    ExpectSame(rest, Y - A * X);
  });
}

TEST(DenseKernelsTest, Tiles) {
  ForKernels([](const DenseKernels& kernels, int m, int k) {
    const Rows P = Rows::Random(m, k);
    const std::vector<double> tiles = InTiles(P);
    // Every other row of an array, the last first; and rows as they come.
    std::vector<int> rows(m);
    Rows picks = Rows::Zero(m, 2 * m);
    for (int i = 0; i < m; ++i) picks(i, rows[i] = 2 * (m - 1 - i)) = 1;
    const Rows X = Rows::Random(k, kBlock), C = Rows::Random(2 * m, kBlock);
    Rows down = C, near = C.topRows(m), up = X, near_up = X;
    kernels.tiles_down(m, k, tiles.data(), X.data(), down.data(), rows.data());
    ExpectSame(down, C - picks.transpose() * P * X);
    kernels.tiles_down(m, k, tiles.data(), X.data(), near.data(), nullptr);
    ExpectSame(near, C.topRows(m) - P * X);
    kernels.tiles_up(m, k, tiles.data(), C.data(), rows.data(), up.data());
    ExpectSame(up, X - P.transpose() * picks * C);
    kernels.tiles_up(m, k, tiles.data(), C.data(), nullptr, near_up.data());
    ExpectSame(near_up, X - P.transpose() * C.topRows(m));
  });
}

TEST(DenseKernelsTest, Triangles) {
  ForKernels([](const DenseKernels& kernels, int, int k) {
    const Rows T = Rows(Rows::Random(k, k)).triangularView<Eigen::Lower>();
    const std::vector<double> tiles = TriangleInTiles(T);
    const Rows X = Rows::Random(k, kBlock), sum = Rows::Random(k, kBlock);
    const Eigen::VectorXd scale = Eigen::VectorXd::Random(k);
    Rows down = X, up = X, used = sum;
    kernels.triangle_down(k, tiles.data(), down.data());
    ExpectSame(down, T * X);
    kernels.triangle_up(k, tiles.data(), scale.data(), used.data(), up.data());
    ExpectSame(up, T.transpose() * scale.asDiagonal() * X + sum);
  });
}

}  // namespace
}  // namespace marrow
