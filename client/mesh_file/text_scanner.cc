#include "client/mesh_file/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/polygon_mesh.h"

namespace marrow {
namespace {

std::string_view WithoutPlus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') {
    token.remove_prefix(1);
  }
  return token;
}

template <typename T>
std::errc Parse(std::string_view token, T* value) {
  const char* end = token.data() + token.size();
  const std::from_chars_result result =
      std::from_chars(token.data(), end, *value);
  if (result.ec == std::errc() && result.ptr != end) {
    return std::errc::invalid_argument;
  }
  return result.ec;
}

// from_chars reports a number beyond the range without saying which end.
double RoundOutOfRange(std::string_view token) {
  const size_t exponent = token.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos &&
                    token.substr(exponent + 1).find('-') == 0;
  const double value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
  return token.front() == '-' ? -value : value;
}

// What a one more in the last digit of the token is worth. REQUIRES: a number.
double LastDigit(std::string_view token) {
  const size_t exponent_at = std::min(token.find_first_of("eE"), token.size());
  const size_t point = token.substr(0, exponent_at).find('.');
  int64_t exponent = 0;
  if (exponent_at < token.size()) {
    ParseInt64(token.substr(exponent_at + 1), &exponent);
  }
  if (point != std::string_view::npos) {
    exponent -= static_cast<int64_t>(exponent_at - point - 1);
  }
  return std::pow(10.0, static_cast<double>(exponent));
}

}  // namespace

TextScanner::TextScanner(std::string path, std::string_view text,
                         Options options)
    : path_(std::move(path)),
      text_(text),
      options_(options),
      newline_(text.find('\n') == std::string_view::npos ? '\r' : '\n') {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    next_line_ = kByteOrderMark.size();
  }
}

bool TextScanner::IsBlank(char c) const {
  return c == ' ' || (c >= '\t' && c <= '\r') ||
         (c == '\\' && options_.continuations);
}

size_t TextScanner::FindLineEnd(size_t from) const {
  size_t end = text_.find(newline_, from);
  while (options_.continuations && end != std::string_view::npos) {
    size_t last = end;
    if (last > from && text_[last - 1] == '\r') --last;
    if (last == from || text_[last - 1] != '\\') break;
    end = text_.find(newline_, end + 1);
  }
  return std::min(end, text_.size());
}

bool TextScanner::NextLine() {
  while (next_line_ < text_.size()) {
    position_ = next_line_;
    end_ = FindLineEnd(position_);
    next_line_ = end_ + 1;
    line_ = lines_passed_ + 1;
    lines_passed_ += 1;
    if (options_.continuations) {
      lines_passed_ +=
          std::count(text_.begin() + position_, text_.begin() + end_, newline_);
    }
    if (options_.comments) {
      const std::string_view line = text_.substr(position_, end_ - position_);
      end_ = position_ + std::min(line.find('#'), line.size());
    }
    while (position_ < end_ && IsBlank(text_[position_])) ++position_;
    if (position_ < end_) return true;
  }
  position_ = end_ = text_.size();
  return false;
}

std::string_view TextScanner::NextToken() {
  while (position_ < end_ && IsBlank(text_[position_])) ++position_;
  const size_t begin = position_;
  while (position_ < end_ && !IsBlank(text_[position_])) ++position_;
  return text_.substr(begin, position_ - begin);
}

std::string_view TextScanner::NextTokenAcrossLines() {
  std::string_view token = NextToken();
  while (token.empty() && NextLine()) token = NextToken();
  return token;
}

absl::Status TextScanner::Error(const std::string& message) const {
  return absl::InvalidArgumentError(
      absl::StrCat(path_, ": line ", line_, ": ", message));
}

size_t TextScanner::NextLineOffset() const {
  return std::min(next_line_, text_.size());
}

bool ParseFloat(std::string_view token, float* value) {
  token = WithoutPlus(token);
  const std::errc error = Parse(token, value);
  if (error != std::errc::result_out_of_range) return error == std::errc();
  double wide = 0;
  ParseDouble(token, &wide);
  *value = ToFloat(wide);
  return true;
}

bool ParseDouble(std::string_view token, double* value) {
  token = WithoutPlus(token);
  const std::errc error = Parse(token, value);
  if (error != std::errc::result_out_of_range) return error == std::errc();
  *value = RoundOutOfRange(token);
  return true;
}

bool FloatSays(std::string_view token, double value) {
  if (IsFloat(value)) return true;
  return std::abs(value - ToFloat(value)) <= 0.5 * LastDigit(token);
}

bool ParseInt64(std::string_view token, int64_t* value) {
  return Parse(WithoutPlus(token), value) == std::errc();
}

std::string Quoted(std::string_view token) {
  constexpr size_t kLongest = 40;
  std::string text(token.substr(0, kLongest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return absl::StrCat("'", text, token.size() > kLongest ? "..." : "", "'");
}

}  // namespace marrow
