#include "core/pipeline/options.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error_reason.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

TEST(OptionsTest, DefaultsAreThePapersAndValid) {
  const SegmentationOptions options;
  EXPECT_TRUE(ValidateOptions(options).ok());
  EXPECT_EQ(options.split.kappa, 1.5);
  EXPECT_EQ(options.split.delta, 0.1);
  EXPECT_EQ(options.split.epsilon, 0.01);
  EXPECT_EQ(options.split.tolerance, 0.01);
  EXPECT_EQ(options.eigen_pairs, 200u);
  EXPECT_EQ(options.levels, 3u);
}

void ExpectRefused(const SegmentationOptions& options,
                   const std::string& field) {
  const absl::Status status = ValidateOptions(options);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << field;
  EXPECT_EQ(FieldOf(status), "options." + field);
  EXPECT_EQ(ReasonOf(status), kReasonInvalidParameter);
  EXPECT_THAT(std::string(status.message()), HasSubstr("options." + field));
}

TEST(OptionsTest, RefusesWhatIsOutOfItsRangeAndNamesIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::string, double SplitOptions::*>> numbers = {
      {"kappa", &SplitOptions::kappa},
      {"delta", &SplitOptions::delta},
      {"epsilon", &SplitOptions::epsilon},
      {"tolerance", &SplitOptions::tolerance}};
  for (const auto& [field, member] : numbers)
    for (double value : {nan, infinity, -infinity, -0.5, 1e9}) {
      SegmentationOptions options;
      options.split.*member = value;
      ExpectRefused(options, field);
    }
  for (uint32_t value : {0u, 1u, 1001u, 4'294'967'295u}) {
    SegmentationOptions options;
    options.eigen_pairs = value;
    ExpectRefused(options, "eigen_pairs");
  }
  for (uint32_t value : {0u, 9u}) {
    SegmentationOptions options;
    options.levels = value;
    ExpectRefused(options, "levels");
  }
}

TEST(OptionsTest, BothEndsOfEveryRangeAreAllowedAndNothingBeyond) {
  for (const ParameterRange& range : ParameterRanges()) {
    auto status_of = [&](double value) {
      SegmentationOptions options;
      const std::string field = range.field;
      if (field == "kappa") options.split.kappa = value;
      if (field == "delta") options.split.delta = value;
      if (field == "epsilon") options.split.epsilon = value;
      if (field == "tolerance") options.split.tolerance = value;
      if (field == "eigen_pairs")
        options.eigen_pairs = static_cast<uint32_t>(value);
      if (field == "levels") options.levels = static_cast<uint32_t>(value);
      return ValidateOptions(options);
    };
    EXPECT_TRUE(status_of(range.min).ok()) << range.field;
    EXPECT_TRUE(status_of(range.max).ok()) << range.field;
    const double above = range.max >= 1 ? range.max + 1 : range.max + 1e-6;
    EXPECT_FALSE(status_of(above).ok()) << range.field;
    const double below = range.min >= 1 ? range.min - 1 : range.min - 1e-6;
    EXPECT_FALSE(status_of(below).ok()) << range.field;
  }
}

TEST(OptionsTest, EigenPairsAloneNameTheirField) {
  EXPECT_TRUE(ValidateEigenPairs(2, "pairs").ok());
  EXPECT_TRUE(ValidateEigenPairs(1000, "pairs").ok());
  EXPECT_EQ(FieldOf(ValidateEigenPairs(1, "pairs")), "pairs");
  EXPECT_EQ(FieldOf(ValidateEigenPairs(1001, "pairs")), "pairs");
  EXPECT_THAT(std::string(ValidateEigenPairs(0, "pairs").message()),
              HasSubstr("is 0, must be from 2 to 1000"));
}

}  // namespace
}  // namespace marrow
