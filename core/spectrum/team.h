// A few threads that share the loops of one computation.
#ifndef MARROW_CORE_SPECTRUM_TEAM_H_
#define MARROW_CORE_SPECTRUM_TEAM_H_

#include <functional>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace marrow {

// What one computation takes: two where there are CPUs for it.
int UsualThreads();

// Runs the iterations of a loop on its threads, the caller's among them. Which
// thread runs which iteration is left to chance, so an iteration must write
// where no other does. Not for use by several callers at a time.
class Team {
 public:
  // One thread is the caller's own: no thread is made then.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const { return static_cast<int>(others_.size()) + 1; }
  // body(0) to body(count - 1); returns when all have returned. An exception
  // of type std::bad_alloc in any of them is thrown again here; others must not
  // be thrown.
  void For(int count, const std::function<void(int)>& body);

 private:
  void Work();
  bool HasWorkOrStops() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    return stopping_ || next_ < count_;
  }
  bool Finished() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    return running_ == 0 && next_ >= count_;
  }
  void RunSome() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_);

  absl::Mutex mu_;
  const std::function<void(int)>* body_ ABSL_GUARDED_BY(mu_) = nullptr;
  int next_ ABSL_GUARDED_BY(mu_) = 0;
  int count_ ABSL_GUARDED_BY(mu_) = 0;
  int running_ ABSL_GUARDED_BY(mu_) = 0;
  bool out_of_memory_ ABSL_GUARDED_BY(mu_) = false;
  bool stopping_ ABSL_GUARDED_BY(mu_) = false;
  std::vector<std::thread> others_;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_TEAM_H_
