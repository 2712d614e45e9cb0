// The last line before a compute thread: nothing thrown passes it.
#ifndef MARROW_SERVER_RUN_GUARDED_H_
#define MARROW_SERVER_RUN_GUARDED_H_

#include <exception>
#include <functional>
#include <new>

#include "absl/status/status.h"
#include "core/base/cancel_token.h"

namespace marrow {

// What `work` answers; CANCELLED at once where `cancel` is cancelled already;
// RESOURCE_EXHAUSTED where memory ran out; INTERNAL for any other exception.
inline absl::Status RunGuarded(const CancelToken& cancel,
                               const std::function<absl::Status()>& work) {
  if (cancel.IsCancelled()) return cancel.Check();
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(
        "the server ran out of memory for this mesh");
  } catch (const std::exception&) {
    return absl::InternalError("the computation failed unexpectedly");
  }
}

}  // namespace marrow

#endif  // MARROW_SERVER_RUN_GUARDED_H_
