// Ctrl-C and its relatives, turned into a function call.
#ifndef MARROW_CLIENT_COMMAND_INTERRUPT_H_
#define MARROW_CLIENT_COMMAND_INTERRUPT_H_

#include <atomic>
#include <functional>
#include <thread>

namespace marrow::client {

// While it lives, the first SIGINT, SIGTERM or SIGHUP calls `on_signal` on a
// thread of its own. A second one, or two seconds more, call `before_exit`,
// which must not take long, and end the process. A signal that was ignored
// before stays so. Make it before any other thread, and one at a time: it
// blocks the signals in the calling thread, whose children inherit that.
class Interrupt {
 public:
  Interrupt(std::function<void()> on_signal, std::function<void()> before_exit);
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // The signal that came, or 0. Any thread may ask.
  int signal() const { return signal_.load(); }

 private:
  void Watch();

  const std::function<void()> on_signal_;
  const std::function<void()> before_exit_;
  std::atomic<int> signal_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread watcher_;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_INTERRUPT_H_
