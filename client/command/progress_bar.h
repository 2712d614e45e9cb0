// One line at the bottom of a terminal that tells how far the work is.
#ifndef MARROW_CLIENT_COMMAND_PROGRESS_BAR_H_
#define MARROW_CLIENT_COMMAND_PROGRESS_BAR_H_

#include <string>

#include "absl/time/time.h"

namespace marrow::client {

// Draws to standard error where that is a terminal, and nothing anywhere else.
// Not thread safe.
class ProgressBar {
 public:
  explicit ProgressBar(bool enabled);
  ~ProgressBar() { Clear(); }

  // `fraction` 0 to 1. Draws at most ten times a second.
  void Show(double fraction, const std::string& text);
  // Takes the line away, so that something else can be written.
  void Clear();

 private:
  const bool enabled_;
  bool shown_ = false;
  absl::Time last_ = absl::InfinitePast();
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_PROGRESS_BAR_H_
