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

std::string CutErrorOf(const CutSpec& cut, Method method) {
  SegmentationOptions options;
  options.method = method;
  const absl::Status status = ValidateCut(cut, options);
  EXPECT_EQ(ReasonOf(status), kReasonInvalidParameter);
  EXPECT_THAT(std::string(status.message()),
              ::testing::StartsWith(FieldOf(status)));
  return std::string(status.message());
}

TEST(OptionsTest, RefusesCutsThatAreOutOfRangeAndSaysWhatIsNot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (Method method : {Method::kPaper, Method::kMerge}) {
    SegmentationOptions options;
    options.method = method;
    EXPECT_TRUE(ValidateCut({}, options).ok());
    for (uint32_t level : {1u, 3u})
      EXPECT_TRUE(ValidateCut(CutSpec::AtLevel(level), options).ok());
    EXPECT_TRUE(ValidateCut(CutSpec::Into(1), options).ok());
    for (uint32_t level : {0u, 4u})
      EXPECT_THAT(CutErrorOf(CutSpec::AtLevel(level), method),
                  HasSubstr("cut.level: is " + std::to_string(level) +
                            ", must be from 1 to 3"));
    EXPECT_THAT(CutErrorOf(CutSpec::Into(0), method),
                HasSubstr("cut.segments: is 0, must be at least 1"));
  }
  SegmentationOptions merging;
  merging.method = Method::kMerge;
  for (double salience : {0.0, 0.5, 1.0})
    EXPECT_TRUE(ValidateCut(CutSpec::AtSalience(salience), merging).ok());
  for (double salience : {-0.1, 1.1, nan})
    EXPECT_THAT(CutErrorOf(CutSpec::AtSalience(salience), Method::kMerge),
                HasSubstr("must be from 0 to 1"));
  EXPECT_THAT(CutErrorOf(CutSpec::AtSalience(1.0000001), Method::kMerge),
              HasSubstr("is 1.0000001, must be from 0 to 1"));
  EXPECT_THAT(CutErrorOf(CutSpec::AtSalience(0.5), Method::kPaper),
              HasSubstr("choose the method merge"));
}

}  // namespace
}  // namespace marrow
