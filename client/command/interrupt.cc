#include "client/command/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/command/exit_code.h"

namespace marrow::client {
namespace {

// Wakes the watcher. One from outside does no harm, as it is ignored otherwise.
constexpr int kWake = SIGURG;

bool IsIgnored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 &&
         action.sa_handler == SIG_IGN;
}

sigset_t WatchedSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, kWake);
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // nohup wants it so, and a shell for what it put into the background.
    if (!IsIgnored(signal)) sigaddset(&signals, signal);
  }
  return signals;
}

// The next signal by the deadline, or 0. Also 0 where `stopping` becomes true.
int NextSignal(absl::Time deadline, const std::atomic<bool>& stopping) {
  const sigset_t signals = WatchedSignals();
  for (absl::Time now = absl::Now(); now < deadline && !stopping;
       now = absl::Now()) {
    const timespec left =
        absl::ToTimespec(std::min(deadline - now, absl::Hours(1)));
    const int signal = sigtimedwait(&signals, nullptr, &left);
    if (signal > 0 && signal != kWake) return signal;
  }
  return 0;
}

}  // namespace

Interrupt::Interrupt(std::function<void()> on_signal,
                     std::function<void()> before_exit)
    : on_signal_(std::move(on_signal)), before_exit_(std::move(before_exit)) {
  const sigset_t signals = WatchedSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::thread([this] { Watch(); });
}

Interrupt::~Interrupt() {
  stopping_ = true;
  pthread_kill(watcher_.native_handle(), kWake);
  watcher_.join();
}

void Interrupt::Watch() {
  const int first = NextSignal(absl::InfiniteFuture(), stopping_);
  if (first == 0) return;
  signal_ = first;
  on_signal_();
  // Whatever reads from a pipe into which nobody writes does not come back.
  constexpr absl::Duration kPatience = absl::Seconds(2);
  const int second = NextSignal(absl::Now() + kPatience, stopping_);
  if (stopping_) return;
  before_exit_();
  _exit(kExitSignal + (second > 0 ? second : first));
}

}  // namespace marrow::client
