#include "server/ticker.h"

#include <utility>

#include "absl/time/time.h"

namespace marrow {
namespace {

const absl::Duration kPeriod = absl::Milliseconds(100);

}  // namespace

Ticker::Ticker() : thread_([this] { Run(); }) {}

Ticker::~Ticker() {
  {
    absl::MutexLock lock(&mu_);
    stopping_ = true;
  }
  thread_.join();
}

void Ticker::Add(std::weak_ptr<Tickable> listener) {
  absl::MutexLock lock(&mu_);
  listeners_.push_back(std::move(listener));
}

std::vector<std::shared_ptr<Tickable>> Ticker::Listeners() {
  absl::MutexLock lock(&mu_);
  std::erase_if(listeners_, [](const auto& weak) { return weak.expired(); });
  std::vector<std::shared_ptr<Tickable>> alive;
  for (const auto& weak : listeners_) {
    if (auto listener = weak.lock()) alive.push_back(std::move(listener));
  }
  return alive;
}

void Ticker::Run() {
  while (true) {
    {
      absl::MutexLock lock(&mu_);
      if (mu_.AwaitWithTimeout(absl::Condition(&stopping_), kPeriod)) return;
    }
    for (const auto& listener : Listeners()) listener->Tick(Clock::now());
  }
}

}  // namespace marrow
