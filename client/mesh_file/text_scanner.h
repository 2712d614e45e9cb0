// Lines and tokens of a text file, with errors that name file and line.
#ifndef MARROW_CLIENT_MESH_FILE_TEXT_SCANNER_H_
#define MARROW_CLIENT_MESH_FILE_TEXT_SCANNER_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace marrow {

// Walks over text that must outlive the scanner. Lines end in LF, CR LF, or CR
// where the text has no LF at all. What follows a '#' is a comment. Not thread
// safe.
class TextScanner {
 public:
  struct Options {
    bool comments = true;
    // A backslash before the end of a line joins the next one to it.
    bool continuations = false;
  };

  TextScanner(std::string path, std::string_view text, Options options);
  TextScanner(std::string path, std::string_view text)
      : TextScanner(std::move(path), text, Options()) {}

  // Goes to the next line with a token in it; false at the end of the text.
  bool NextLine();
  // The next token of this line; empty at its end.
  std::string_view NextToken();
  // The next token, on this line or a later one; empty at the end of the text.
  std::string_view NextTokenAcrossLines();

  // INVALID_ARGUMENT "PATH: line N: MESSAGE".
  absl::Status Error(const std::string& message) const;
  // Number of the line that was read last, from 1.
  size_t line() const { return line_; }
  const std::string& path() const { return path_; }
  // Byte at which the next line begins, at most the size of the text.
  size_t NextLineOffset() const;

 private:
  bool IsBlank(char c) const;
  size_t FindLineEnd(size_t from) const;

  const std::string path_;
  const std::string_view text_;
  const Options options_;
  const char newline_;
  size_t next_line_ = 0;  // where the next line begins
  size_t position_ = 0;   // in the current line
  size_t end_ = 0;        // of the current line, without its comment
  size_t line_ = 0;
  size_t lines_passed_ = 0;  // newlines before next_line_
};

// True where the whole token is a number. Takes what C writes for infinities
// and NaN in any case, and a leading '+'. Too large becomes an infinity, too
// small zero, as rounding has it.
bool ParseFloat(std::string_view token, float* value);
bool ParseDouble(std::string_view token, double* value);
// Whether the float nearest to the `value` of a token says as much as the
// token: the two differ by at most half of its last digit. So "0.1" is a float,
// and "0.10000000001" and "16777217" are not.
bool FloatSays(std::string_view token, double value);
bool ParseInt64(std::string_view token, int64_t* value);

// "'TOKEN'", cut short where it is long and with control bytes as '?'.
std::string Quoted(std::string_view token);

}  // namespace marrow

#endif  // MARROW_CLIENT_MESH_FILE_TEXT_SCANNER_H_
