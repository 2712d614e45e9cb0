#include "core/pipeline/options.h"

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr ParameterRange kRanges[] = {
    {"kappa", 0.1, 10},    {"delta", 0.001, 0.999},  {"epsilon", 0, 1},
    {"tolerance", 0, 0.5}, {"eigen_pairs", 2, 1000}, {"levels", 1, 8},
};

absl::Status CheckRange(const std::string& field, double value,
                        const ParameterRange& range) {
  // Written so that NaN fails.
  if (value >= range.min && value <= range.max) return absl::OkStatus();
  return InvalidField(field, absl::StrCat("is ", value, ", must be from ",
                                          range.min, " to ", range.max));
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

absl::Status ValidateEigenPairs(uint32_t eigen_pairs, const char* field) {
  return CheckRange(field, eigen_pairs, kRanges[4]);
}

}  // namespace marrow
