#include "core/pipeline/options.h"

#include <array>
#include <charconv>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr ParameterRange kRanges[] = {
    {"kappa", 0.1, 10},    {"delta", 0.001, 0.999},  {"epsilon", 0, 1},
    {"tolerance", 0, 0.5}, {"eigen_pairs", 2, 1000}, {"levels", 1, 8},
};

// The fewest digits that read back as the same number, so that no value looks
// like the bound that it misses.
std::string Shortest(double value) {
  std::array<char, 32> digits;
  char* end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return std::string(digits.data(), end);
}

absl::Status CheckRange(const std::string& field, double value,
                        const ParameterRange& range) {
  // Written so that NaN fails.
  if (value >= range.min && value <= range.max) return absl::OkStatus();
  return InvalidField(
      field, absl::StrCat("is ", Shortest(value), ", must be from ",
                          Shortest(range.min), " to ", Shortest(range.max)));
}

}  // namespace

std::span<const ParameterRange> ParameterRanges() { return kRanges; }

absl::Status ValidateOptions(const SegmentationOptions& options) {
  const double values[] = {options.split.kappa,
                           options.split.delta,
                           options.split.epsilon,
                           options.split.tolerance,
                           static_cast<double>(options.eigen_pairs),
                           static_cast<double>(options.levels)};
  for (size_t i = 0; i < std::size(kRanges); ++i)
    MARROW_RETURN_IF_ERROR(CheckRange(
        absl::StrCat("options.", kRanges[i].field), values[i], kRanges[i]));
  return absl::OkStatus();
}

absl::Status ValidateCut(const CutSpec& cut,
                         const SegmentationOptions& options) {
  switch (cut.by) {
    case CutSpec::By::kAutomatic:
      return absl::OkStatus();
    case CutSpec::By::kLevel:
      if (cut.level >= 1 && cut.level <= options.levels)
        return absl::OkStatus();
      return InvalidField(
          "cut.level",
          absl::StrCat("is ", cut.level, ", must be from 1 to ", options.levels,
                       ", the number of levels of the tree"));
    case CutSpec::By::kSegments:
      if (cut.segments >= 1) return absl::OkStatus();
      return InvalidField("cut.segments", "is 0, must be at least 1");
    case CutSpec::By::kSalience:
      if (options.method == Method::kPaper)
        return InvalidField("cut.salience",
                            "the paper's method knows no salience; cut by "
                            "level or by number of segments, or choose the "
                            "method merge");
      return CheckRange("cut.salience", cut.salience, {"salience", 0, 1});
  }
  return absl::OkStatus();
}

absl::Status ValidateEigenPairs(uint32_t eigen_pairs, const char* field) {
  return CheckRange(field, eigen_pairs, kRanges[4]);
}

}  // namespace marrow
