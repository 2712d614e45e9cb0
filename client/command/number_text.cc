#include "client/command/number_text.h"

#include <cmath>

#include "absl/strings/numbers.h"

namespace marrow::client {

bool ReadWholeNumber(const std::string& text, uint32_t& value) {
  // CLI11 reads numbers once more, and takes 010 for octal.
  const bool plain =
      text.find_first_not_of("0123456789") == std::string::npos &&
      (text.size() == 1 || !text.starts_with('0'));
  return plain && absl::SimpleAtoi(text, &value);
}

bool ReadNumber(const std::string& text, double& value) {
  return text.find_first_not_of("0123456789.+-eE") == std::string::npos &&
         absl::SimpleAtod(text, &value) && std::isfinite(value);
}

}  // namespace marrow::client
