// Lines on their way to a file descriptor, written by a thread of its own.
#ifndef MARROW_SERVER_LINE_WRITER_H_
#define MARROW_SERVER_LINE_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "absl/time/time.h"

namespace marrow {

// Whoever hands in a line never waits for whoever reads it. Thread safe.
class LineWriter {
 public:
  // Lines that wait, all together.
  static constexpr size_t kMaxWaitingBytes = 1 << 20;

  // `fd` stays the caller's, and open until all is flushed. `note_of` makes the
  // line that tells how many were dropped; it is called on the writing thread.
  LineWriter(int fd, std::function<std::string(uint64_t)> note_of);
  // Does not wait: what is not flushed may be lost.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  // Takes a line that ends in a line break. Dropped where too many wait, and
  // where it cannot be written; a note follows once something can be.
  void Write(std::string line);

  // Waits until all lines are written or `limit` is over; false in that case.
  bool Flush(absl::Duration limit);

 private:
  struct State;
  static void Run(State& state);

  const std::shared_ptr<State> state_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_LINE_WRITER_H_
