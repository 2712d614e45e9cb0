#include "client/command/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"

namespace marrow::client {
namespace {

constexpr int kBarWidth = 24;

size_t TerminalWidth() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0
             ? size.ws_col
             : 80;
}

}  // namespace

ProgressBar::ProgressBar(bool enabled)
    : enabled_(enabled && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(double fraction, const std::string& text) {
  const absl::Time now = absl::Now();
  if (!enabled_ || now - last_ < absl::Milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const size_t filled = static_cast<size_t>(kBarWidth * fraction);
  std::string line =
      absl::StrFormat("[%s%s] %3d%%  %s", std::string(filled, '='),
                      std::string(kBarWidth - filled, ' '),
                      static_cast<int>(100 * fraction), text);
  // A line that wraps could not be taken back.
  line.resize(std::min(line.size(), TerminalWidth() - 1));
  std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
  std::fflush(stderr);
}

void ProgressBar::Clear() {
  if (!shown_) return;
  shown_ = false;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

}  // namespace marrow::client
