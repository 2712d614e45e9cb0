#include "core/spectrum/overlap_estimate.h"

#include <algorithm>
#include <vector>

#include "gtest/gtest.h"

namespace marrow {
namespace {

constexpr int kRows = 1200;
constexpr int kBlocks = 14;

// Block Lanczos with the inverse of a diagonal matrix, whose entries are about
// a shift as a surface's eigenvalues are.
struct Process {
  Process() : team(1), basis(kRows, blocks, team) {
    for (int i = 0; i < kRows; ++i) theta[i] = 1 / (i - 30.3);
  }

  Eigen::Map<RowMajorMatrix> Block(int b) {
    return {basis.Block(b), kRows, kBlock};
  }

  // Makes the next block orthogonal to the last two, or to all.
  LanczosBasis::Growth Step(bool to_all) {
    if (basis.num_blocks() == 0) {
      basis.FillRandomly(basis.Block(0), 1);
    } else {
      const RowMajorMatrix last = Block(basis.num_blocks() - 1);
      RowMajorMatrix next = theta.matrix().asDiagonal() * last;
      next += disturbance * RowMajorMatrix::Random(kRows, kBlock);
      Block(basis.num_blocks()) = next;
    }
    LanczosBasis::Growth growth;
    const auto fill = [](double*) { return absl::OkStatus(); };
    const auto wants_all = [&](const LanczosBasis::Growth&) { return to_all; };
    EXPECT_TRUE(basis.Append(fill, wants_all, CancelToken(), growth).ok());
    return growth;
  }

  // The overlap of the last block with those before it.
  double Overlap() {
    double worst = 0;
    for (int b = 0; b + 1 < basis.num_blocks(); ++b)
      worst =
          std::max(worst, (Block(b).transpose() * Block(basis.num_blocks() - 1))
                              .cwiseAbs()
                              .maxCoeff());
    return worst;
  }

  // `growth` is that of the last block.
  void GrowT(const LanczosBasis::Growth& growth) {
    const Eigen::Index rows = growth.projection.rows();
    T.conservativeResize(rows, rows);
    T.rightCols(kBlock) = growth.projection;
    T.bottomRows(kBlock) = growth.projection.transpose();
  }

  // As factors disturb it that are bad.
  double disturbance = 0;
  Eigen::ArrayXd theta = Eigen::ArrayXd::Zero(kRows);
  std::vector<AlignedBuffer> blocks;
  Team team;
  LanczosBasis basis;
  Eigen::MatrixXd T;
};

// It grows by many decades, and is known within one or two all the way.
TEST(OverlapEstimateTest, FollowsTheOverlapThatThereIs) {
  Process process;
  OverlapEstimate estimate;
  process.Step(true);
  estimate.AppendOrthogonal(0);
  double most = 0;
  for (int b = 1; b < kBlocks; ++b) {
    const LanczosBasis::Growth growth = process.Step(false);
    const Eigen::MatrixXd overlap = estimate.Next(process.T, growth);
    const double guess = overlap.cwiseAbs().maxCoeff();
    const double truth = process.Overlap();
    EXPECT_GT(guess, 0.1 * truth) << b;
    if (b > 2) {
      EXPECT_LT(guess, 1000 * truth) << b;
    }
    most = std::max(most, truth);
    if (truth > 1e-4) break;
    process.GrowT(growth);
    estimate.NoteRounding(growth);
    estimate.Append(overlap);
  }
  EXPECT_GT(most, 1e-4);
}

TEST(OverlapEstimateTest, KnowsOfAnOperatorThatIsDisturbed) {
  Process process;
  process.disturbance = 1e-7;
  OverlapEstimate estimate;
  estimate.NoteRounding(process.Step(true));
  estimate.AppendOrthogonal(0);
  for (int b = 1; b < 7; ++b) {
    const LanczosBasis::Growth growth = process.Step(false);
    const Eigen::MatrixXd overlap = estimate.Next(process.T, growth);
    EXPECT_GT(overlap.cwiseAbs().maxCoeff(), 0.1 * process.Overlap()) << b;
    if (b > 2) {
      EXPECT_GT(process.Overlap(), 1e-9) << b;
    }
    process.GrowT(growth);
    estimate.NoteRounding(growth);
    estimate.Append(overlap);
  }
}

TEST(OverlapEstimateTest, StartsAgainFromBlocksThatDoNotOverlap) {
  Process process;
  OverlapEstimate estimate;
  process.Step(true);
  estimate.AppendOrthogonal(0);
  for (int b = 1; b < 8; ++b) {
    const LanczosBasis::Growth growth = process.Step(true);
    EXPECT_LT(estimate.Next(process.T, growth).cwiseAbs().maxCoeff(), 1e-10)
        << b;
    process.GrowT(growth);
    estimate.AppendOrthogonal(process.T.rows());
  }
}

}  // namespace
}  // namespace marrow
