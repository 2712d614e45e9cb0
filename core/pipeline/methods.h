// The two methods: prepared bodies -> levels and the tree, to the sink.
#ifndef MARROW_CORE_PIPELINE_METHODS_H_
#define MARROW_CORE_PIPELINE_METHODS_H_

#include "absl/status/status.h"
#include "core/pipeline/job.h"

namespace marrow {

// METHOD_PAPER. Every level leaves as soon as it is known; the first split of
// several bodies is into them. Errors: CANCELLED.
absl::Status SplitLevels(const Job& job);

// METHOD_MERGE. Level k of several bodies is made of level k of each.
// Errors: CANCELLED.
absl::Status MergeLevels(const Job& job);

}  // namespace marrow

#endif  // MARROW_CORE_PIPELINE_METHODS_H_
