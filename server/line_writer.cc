#include "server/line_writer.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace marrow {
namespace {

bool WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(fd, bytes.data(), bytes.size());
    if (written > 0) bytes.remove_prefix(static_cast<size_t>(written));
    if (written >= 0 || errno == EINTR) continue;
    // Whoever shares the descriptor may have made it non-blocking.
    if (errno != EAGAIN) return false;
    pollfd ready{fd, POLLOUT, 0};
    poll(&ready, 1, -1);
  }
  return true;
}

}  // namespace

// Shared with the thread, which may wait for a reader for ever and is then left
// behind.
struct LineWriter::State {
  State(int descriptor, std::function<std::string(uint64_t)> note)
      : fd(descriptor), note_of(std::move(note)) {}

  bool HasWorkOrStops() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu) {
    return stopping || !lines.empty();
  }
  bool IsIdle() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu) {
    return lines.empty() && !writing;
  }

  const int fd;
  const std::function<std::string(uint64_t)> note_of;
  absl::Mutex mu;
  std::vector<std::string> lines ABSL_GUARDED_BY(mu);
  size_t bytes ABSL_GUARDED_BY(mu) = 0;  // of `lines`
  uint64_t dropped ABSL_GUARDED_BY(mu) = 0;
  bool writing ABSL_GUARDED_BY(mu) = false;
  bool stopping ABSL_GUARDED_BY(mu) = false;
};

LineWriter::LineWriter(int fd, std::function<std::string(uint64_t)> note_of)
    : state_(std::make_shared<State>(fd, std::move(note_of))) {
  std::thread([state = state_] { Run(*state); }).detach();
}

LineWriter::~LineWriter() {
  absl::MutexLock lock(&state_->mu);
  state_->stopping = true;
}

void LineWriter::Write(std::string line) {
  absl::MutexLock lock(&state_->mu);
  if (state_->bytes + line.size() > kMaxWaitingBytes) {
    ++state_->dropped;
    return;
  }
  state_->bytes += line.size();
  state_->lines.push_back(std::move(line));
}

bool LineWriter::Flush(absl::Duration limit) {
  absl::MutexLock lock(&state_->mu);
  return state_->mu.AwaitWithTimeout(
      absl::Condition(state_.get(), &State::IsIdle), limit);
}

void LineWriter::Run(State& state) {
  while (true) {
    std::vector<std::string> lines;
    uint64_t dropped = 0;
    {
      absl::MutexLock lock(&state.mu);
      state.mu.Await(absl::Condition(&state, &State::HasWorkOrStops));
      if (state.lines.empty()) return;
      lines.swap(state.lines);
      state.bytes = 0;
      // Those came after the lines that are taken, and before any later one.
      dropped = std::exchange(state.dropped, 0);
      state.writing = true;
    }
    uint64_t lost = 0;
    for (const std::string& line : lines) lost += !WriteAll(state.fd, line);
    if (dropped > 0 && !WriteAll(state.fd, state.note_of(dropped))) {
      lost += dropped;
    }
    absl::MutexLock lock(&state.mu);
    state.dropped += lost;
    state.writing = false;
  }
}

}  // namespace marrow
