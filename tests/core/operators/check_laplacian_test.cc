#include <limits>
#include <string>

#include "core/operators/laplacian.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

class CheckLaplacianTest : public ::testing::Test {
 protected:
  void ExpectBroken(const std::string& text) {
    const absl::Status status = CheckLaplacian(laplacian_);
    EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
    EXPECT_THAT(std::string(status.message()), HasSubstr(text));
  }

  Laplacian laplacian_ = *BuildLaplacian(Icosphere(2));
};

TEST_F(CheckLaplacianTest, AcceptsWhatIsBuilt) {
  EXPECT_EQ(CheckLaplacian(laplacian_), absl::OkStatus());
}

TEST_F(CheckLaplacianTest, FindsTheLastBitOfAsymmetry) {
  double& entry = laplacian_.L.coeffRef(0, laplacian_.L.innerIndexPtr()[1]);
  entry = std::nextafter(entry, 0);
  ExpectBroken("without an equal twin");
}

TEST_F(CheckLaplacianTest, FindsAMissingTwin) {
  // Weightless, so that the sums stay right.
  laplacian_.L.coeffRef(0, 161) = 0;
  laplacian_.L.makeCompressed();
  ExpectBroken("without an equal twin");
}

TEST_F(CheckLaplacianTest, FindsANegativeWeight) {
  const int j = laplacian_.L.innerIndexPtr()[1];
  const double weight = -laplacian_.L.coeff(0, j);
  for (const auto& [row, column] : {std::pair{0, j}, std::pair{j, 0}})
    laplacian_.L.coeffRef(row, column) += weight + 1e-10;
  laplacian_.L.coeffRef(0, 0) -= weight + 1e-10;
  laplacian_.L.coeffRef(j, j) -= weight + 1e-10;
  ExpectBroken("a negative weight in row 0");
}

TEST_F(CheckLaplacianTest, FindsARowThatDoesNotSumToZero) {
  laplacian_.L.coeffRef(7, 7) += 1e-10;
  ExpectBroken("a sum in row 7");
}

TEST_F(CheckLaplacianTest, FindsWhatIsNotFinite) {
  laplacian_.L.coeffRef(3, 3) = std::numeric_limits<double>::quiet_NaN();
  ExpectBroken("in row 3");
}

TEST_F(CheckLaplacianTest, FindsBadMasses) {
  laplacian_.M[5] = 0;
  ExpectBroken("no mass in row 5");
  laplacian_.M.setConstant(1);
  ExpectBroken("do not sum to 1");
  laplacian_.M.conservativeResize(7);
  ExpectBroken("shape");
}

}  // namespace
}  // namespace marrow
