#include "client/command/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

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
  for (int signal = 0; sigwait(&signals, &signal) == 0;) {
    if (stopping_) return;
    if (signal_ != 0) _exit(kExitSignal + signal);
    signal_ = signal;
    on_signal_();
  }
}

}  // namespace marrow::client
