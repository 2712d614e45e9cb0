#include "core/spectrum/team.h"

#include <algorithm>
#include <new>

namespace marrow {

int UsualThreads() {
  return static_cast<int>(
      std::clamp(std::thread::hardware_concurrency(), 1u, 2u));
}

Team::Team(int threads) {
  for (int i = 1; i < threads; ++i) others_.emplace_back([this] { Work(); });
}

Team::~Team() {
  {
    absl::MutexLock lock(&mu_);
    stopping_ = true;
  }
  for (std::thread& other : others_) other.join();
}

void Team::For(int count, const std::function<void(int)>& body) {
  if (others_.empty()) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  absl::MutexLock lock(&mu_);
  body_ = &body;
  next_ = 0;
  count_ = count;
  RunSome();
  mu_.Await(absl::Condition(this, &Team::Finished));
  count_ = 0;
  if (!out_of_memory_) return;
  out_of_memory_ = false;
  throw std::bad_alloc();
}

void Team::Work() {
  absl::MutexLock lock(&mu_);
  while (true) {
    mu_.Await(absl::Condition(this, &Team::HasWorkOrStops));
    if (stopping_) return;
    RunSome();
  }
}

void Team::RunSome() {
  ++running_;
  while (next_ < count_) {
    const int i = next_++;
    const std::function<void(int)>& body = *body_;
    mu_.Unlock();
    bool failed = false;
    try {
      body(i);
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    mu_.Lock();
    out_of_memory_ |= failed;
  }
  --running_;
}

}  // namespace marrow
