// A flag that tells a computation that nobody waits for it any more.
#ifndef MARROW_CORE_BASE_CANCEL_TOKEN_H_
#define MARROW_CORE_BASE_CANCEL_TOKEN_H_

#include <atomic>

#include "absl/status/status.h"

namespace marrow {

// Thread safety: any thread may cancel, any thread may ask. Cancelling cannot
// be taken back. Loops of the core ask at least every 50 ms of work.
class CancelToken {
 public:
  CancelToken() = default;
  CancelToken(const CancelToken&) = delete;
  CancelToken& operator=(const CancelToken&) = delete;

  void Cancel() { cancelled_.store(true, std::memory_order_release); }
  bool IsCancelled() const {
    return cancelled_.load(std::memory_order_acquire);
  }
  // OK, or CANCELLED.
  absl::Status Check() const {
    return IsCancelled() ? absl::CancelledError("the request was cancelled")
                         : absl::OkStatus();
  }

 private:
  std::atomic<bool> cancelled_{false};
};

}  // namespace marrow

#endif  // MARROW_CORE_BASE_CANCEL_TOKEN_H_
