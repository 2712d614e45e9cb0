#include "core/spectrum/lanczos_basis.h"

#include <array>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"

namespace marrow {
namespace {

constexpr int kRows = 1500;  // several chunks, and no whole number of them

using BlockMap = Eigen::Map<RowMajorMatrix>;

// A basis with the memory and the team that it wants.
struct Fixture {
  explicit Fixture(int threads = 1)
      : team(threads), basis(kRows, blocks, team) {}

  BlockMap Next() {
    return BlockMap(basis.Block(basis.num_blocks()), kRows, kBlock);
  }
  // Columns are all vectors of the basis.
  Eigen::MatrixXd V() {
    Eigen::MatrixXd all(kRows, basis.dimension());
    for (int b = 0; b < basis.num_blocks(); ++b)
      all.middleCols(b * kBlock, kBlock) =
          BlockMap(basis.Block(b), kRows, kBlock);
    return all;
  }
  LanczosBasis::Growth Append(bool to_all = true) {
    LanczosBasis::Growth growth;
    const auto wants_all = [&](const LanczosBasis::Growth&) { return to_all; };
    const auto fill = [&](double* Z) {
      ++fills;
      basis.FillRandomly(Z, 77 + fills);
      return absl::OkStatus();
    };
    EXPECT_TRUE(basis.Append(fill, wants_all, CancelToken(), growth).ok());
    return growth;
  }
  double Disorder() {
    const Eigen::MatrixXd all = V();
    return (all.transpose() * all -
            Eigen::MatrixXd::Identity(all.cols(), all.cols()))
        .cwiseAbs()
        .maxCoeff();
  }

  std::vector<AlignedBuffer> blocks;
  Team team;
  LanczosBasis basis;
  int fills = 0;
};

// Appends W and checks that it is what the growth says.
void ExpectGrowth(Fixture& fixture, const RowMajorMatrix& W,
                  double disorder = 1e-12) {
  const int before = fixture.basis.dimension();
  fixture.Next() = W;
  const LanczosBasis::Growth growth = fixture.Append();
  ASSERT_EQ(fixture.basis.dimension(), before + kBlock);
  ASSERT_EQ(growth.projection.rows(), before);
  EXPECT_LT(fixture.Disorder(), disorder);
  const Eigen::MatrixXd V = fixture.V();
  const Eigen::MatrixXd again = V.leftCols(before) * growth.projection +
                                V.rightCols(kBlock) * growth.remainder;
  for (int c = 0; c < kBlock; ++c)
    EXPECT_LT((again.col(c) - W.col(c)).norm(), 1e-12 * W.norm()) << c;
}

RowMajorMatrix Random(int seed) {
  srand(100 + seed);
  return RowMajorMatrix::Random(kRows, kBlock);
}

TEST(LanczosBasisTest, BlocksAreOrthonormalAndNothingIsLost) {
  Fixture fixture(2);
  for (int b = 0; b < 12; ++b) ExpectGrowth(fixture, Random(b));
  EXPECT_EQ(fixture.fills, 0);
}

// Orthogonality is kept as the header says, however little of a block is new.
TEST(LanczosBasisTest, NearlyDependentBlocksAreOrthonormalToo) {
  for (double share : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    SCOPED_TRACE(share);
    Fixture fixture;
    ExpectGrowth(fixture, Random(1));
    const Eigen::MatrixXd V = fixture.V();
    ExpectGrowth(fixture, V + share * Random(2), kMostMagnification * 3e-16);
    EXPECT_EQ(fixture.fills, 0);
  }
}

TEST(LanczosBasisTest, ColumnsMayBeOfVeryDifferentLength) {
  Fixture fixture;
  RowMajorMatrix W = Random(3);
  for (int c = 0; c < kBlock; ++c) W.col(c) *= std::pow(10.0, 2 * c - 8);
  ExpectGrowth(fixture, W);
  EXPECT_EQ(fixture.fills, 0);
}

// What has no new direction is filled with one, and its remainder is none.
TEST(LanczosBasisTest, MissingDirectionsAreFilled) {
  Fixture fixture;
  ExpectGrowth(fixture, Random(4));
  ExpectGrowth(fixture, Random(5));
  const Eigen::MatrixXd V = fixture.V();
  RowMajorMatrix W = Random(6);
  W.col(1) = V.col(2) - 3 * V.col(9);
  W.col(4) = W.col(3);
  W.col(6).setZero();
  ExpectGrowth(fixture, W);
  EXPECT_GT(fixture.fills, 0);
  fixture.fills = 0;
  ExpectGrowth(fixture, V.leftCols(kBlock));
  EXPECT_GT(fixture.fills, 0);
}

TEST(LanczosBasisTest, ABlockIsOrthogonalToTheLastTwoIfNoMoreIsWanted) {
  Fixture fixture;
  for (int b = 0; b < 4; ++b) ExpectGrowth(fixture, Random(b));
  fixture.Next() = Random(4);
  const LanczosBasis::Growth growth = fixture.Append(false);
  EXPECT_FALSE(growth.is_to_all);
  const Eigen::MatrixXd V = fixture.V();
  const Eigen::MatrixXd overlap =
      V.leftCols(4 * kBlock).transpose() * V.rightCols(kBlock);
  EXPECT_LT(overlap.bottomRows(2 * kBlock).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT(overlap.topRows(kBlock).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(LanczosBasisTest, TheLastTwoBlocksAreSeparatedFromTheRest) {
  Fixture fixture(2);
  for (int b = 0; b < 6; ++b) ExpectGrowth(fixture, Random(b));
  for (int b : {4, 5})
    BlockMap(fixture.basis.Block(b), kRows, kBlock) +=
        1e-8 * fixture.V().leftCols(kBlock);
  EXPECT_GT(fixture.Disorder(), 0.9e-8);
  ASSERT_TRUE(fixture.basis.SeparateLastTwo(CancelToken()).ok());
  EXPECT_LT(fixture.Disorder(), 1e-14);
}

TEST(LanczosBasisTest, CombinesAsADenseProduct) {
  Fixture fixture(2);
  for (int b = 0; b < 5; ++b) ExpectGrowth(fixture, Random(b));
  const RowMajorMatrix coefficients =
      RowMajorMatrix::Random(fixture.basis.dimension(), 2 * kBlock);
  const std::array<double*, 2> Y = {fixture.basis.Block(5),
                                    fixture.basis.Block(6)};
  ASSERT_TRUE(fixture.basis.Combine(coefficients, Y, CancelToken()).ok());
  const Eigen::MatrixXd exact = fixture.V() * coefficients;
  for (int b = 0; b < 2; ++b)
    EXPECT_LT(
        (BlockMap(Y[b], kRows, kBlock) - exact.middleCols(b * kBlock, kBlock))
            .norm(),
        1e-12);
}

TEST(LanczosBasisTest, TheSameBytesWhateverTheTeam) {
  Fixture one(1), three(3);
  for (int b = 0; b < 6; ++b)
    for (Fixture* fixture : {&one, &three}) {
      fixture->Next() = b == 3 ? one.V().leftCols(kBlock) : Random(b);
      fixture->Append();
    }
  EXPECT_GT(one.fills, 0);
  EXPECT_EQ(one.V(), three.V());
}

TEST(LanczosBasisTest, StopsWhenCancelled) {
  Fixture fixture;
  fixture.Next() = Random(1);
  CancelToken cancel;
  cancel.Cancel();
  LanczosBasis::Growth growth;
  const auto fill = [](double*) { return absl::OkStatus(); };
  const auto wants_all = [](const LanczosBasis::Growth&) { return false; };
  EXPECT_EQ(fixture.basis.Append(fill, wants_all, cancel, growth).code(),
            absl::StatusCode::kCancelled);
  EXPECT_EQ(fixture.basis.num_blocks(), 0);
}

TEST(LanczosBasisTest, OrthonormaliserOfAGramMatrix) {
  const RowMajorMatrix W = Random(8).topRows(40);
  const RowMajorMatrix gram = W.transpose() * W;
  const Orthonormaliser q = MakeOrthonormaliser(gram, gram.diagonal());
  EXPECT_TRUE(q.complete);
  const RowMajorMatrix Q = W * q.B;
  EXPECT_LT((Q.transpose() * Q - RowMajorMatrix::Identity(kBlock, kBlock))
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
  EXPECT_LT((Q * q.R - W).norm(), 1e-12 * W.norm());
}

}  // namespace
}  // namespace marrow
