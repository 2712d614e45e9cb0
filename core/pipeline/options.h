// Parameters of a segmentation, their ranges and their defaults.
#ifndef MARROW_CORE_PIPELINE_OPTIONS_H_
#define MARROW_CORE_PIPELINE_OPTIONS_H_

#include <cstdint>
#include <span>

#include "absl/status/status.h"
#include "core/hierarchy/cut.h"
#include "core/pieces/split_region.h"

namespace marrow {

// Changes whenever equal requests may give other answers.
inline constexpr char kAlgorithmRevision[] = "paper/8 merge/16";

enum class Method {
  kPaper,  // top-down: a level is a depth of the recursion
  kMerge,  // bottom-up: a level is a threshold of salience
};

struct SegmentationOptions {
  Method method = Method::kMerge;
  SplitOptions split;          // kMerge has a kappa of its own
  uint32_t eigen_pairs = 200;  // besides the constant one
  uint32_t levels = 3;         // kMerge gives at most 3
};

// The range of one parameter, both ends allowed; `field` is its name in
// marrow.v1.SegmentationOptions.
struct ParameterRange {
  const char* field;
  double min;
  double max;
};
std::span<const ParameterRange> ParameterRanges();

// INVALID_ARGUMENT that names the field, such as "options.kappa", its value
// and its range. NaN is out of every range.
absl::Status ValidateOptions(const SegmentationOptions& options);
// INVALID_ARGUMENT that names the field, such as "cut.level". What nodes it
// names is seen once there is a tree. REQUIRES: the options are valid.
absl::Status ValidateCut(const CutSpec& cut,
                         const SegmentationOptions& options);
absl::Status ValidateEigenPairs(uint32_t eigen_pairs, const char* field);

}  // namespace marrow

#endif  // MARROW_CORE_PIPELINE_OPTIONS_H_
