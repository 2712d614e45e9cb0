#include "client/command/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <utility>

#include "client/command/exit_code.h"

namespace marrow::client {
namespace {

sigset_t WatchedSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

}  // namespace

Interrupt::Interrupt(std::function<void()> on_signal)
    : on_signal_(std::move(on_signal)) {
  const sigset_t signals = WatchedSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::thread([this] { Watch(); });
}

Interrupt::~Interrupt() {
  stopping_ = true;
  // Wakes the watcher alone.
  pthread_kill(watcher_.native_handle(), SIGHUP);
  watcher_.join();
}

void Interrupt::Watch() {
  const sigset_t signals = WatchedSignals();
  int first = 0;
  while (sigwait(&signals, &first) != 0) {
  }
  if (stopping_) return;
  signal_ = first;
  on_signal_();
  // Whatever reads from a pipe into which nobody writes does not come back.
  constexpr timespec kPatience{2, 0};
  int second = 0;
  do {
    second = sigtimedwait(&signals, nullptr, &kPatience);
  } while (second < 0 && errno == EINTR);
  if (!stopping_) _exit(kExitSignal + (second > 0 ? second : first));
}

}  // namespace marrow::client
