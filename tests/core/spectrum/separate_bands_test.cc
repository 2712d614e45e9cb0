#include "core/spectrum/separate_bands.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

namespace marrow {
namespace {

constexpr int kRows = 200, kBefore = 5, kColumns = 9;

struct Bands {
  Eigen::VectorXd mass = Eigen::VectorXd::LinSpaced(kRows, 0.001, 0.009);
  EigenvectorMatrix vectors;
};

// M-orthonormal but for column 7, which has `overlap` of columns 1 and 3.
Bands MakeBands(float overlap) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd any = Eigen::MatrixXd::NullaryExpr(
      kRows, kColumns, [&] { return normal(random); });
  const Eigen::MatrixXd Q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ() *
      Eigen::MatrixXd::Identity(kRows, kColumns);
  Bands bands;
  bands.vectors =
      (bands.mass.cwiseSqrt().cwiseInverse().asDiagonal() * Q).cast<float>();
  bands.vectors.col(7) +=
      overlap * (bands.vectors.col(1) - bands.vectors.col(3));
  return bands;
}

double WorstOverlap(const Bands& bands) {
  const Eigen::MatrixXd Phi = bands.vectors.cast<double>();
  return (Phi.transpose() * bands.mass.asDiagonal() * Phi -
          Eigen::MatrixXd::Identity(kColumns, kColumns))
      .cwiseAbs()
      .maxCoeff();
}

TEST(SeparateBandsTest, WhatALaterColumnHasOfEarlierOnesIsTaken) {
  Bands bands = MakeBands(1e-3f);
  EXPECT_GT(WorstOverlap(bands), 9e-4);
  std::vector<double> residuals(kColumns, 1e-9);
  residuals[7] = 1e-4;
  SeparateBands(bands.mass, residuals, 1e-5, kBefore, CancelToken(),
                bands.vectors);
  EXPECT_LT(WorstOverlap(bands), 5e-6);
}

// Whichever of the two has the residual, the later one gives way.
TEST(SeparateBandsTest, AnEarlierColumnStaysAsItWas) {
  Bands bands = MakeBands(1e-3f);
  const EigenvectorMatrix before = bands.vectors;
  std::vector<double> residuals(kColumns, 1e-9);
  residuals[1] = residuals[3] = 1e-4;
  SeparateBands(bands.mass, residuals, 1e-5, kBefore, CancelToken(),
                bands.vectors);
  EXPECT_LT(WorstOverlap(bands), 5e-6);
  EXPECT_EQ(bands.vectors.leftCols(kBefore), before.leftCols(kBefore));
}

TEST(SeparateBandsTest, WithoutLooseColumnsNothingIsTouched) {
  Bands bands = MakeBands(1e-3f);
  const EigenvectorMatrix before = bands.vectors;
  SeparateBands(bands.mass, std::vector<double>(kColumns, 1e-6), 1e-5, kBefore,
                CancelToken(), bands.vectors);
  EXPECT_EQ(bands.vectors, before);
}

}  // namespace
}  // namespace marrow
