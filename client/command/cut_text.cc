#include "client/command/cut_text.h"

#include <cstdint>

#include "absl/strings/str_cat.h"
#include "client/command/number_text.h"

namespace marrow::client {
namespace {

constexpr char kAutomatic[] = "auto";

// Whether the text is a cut, which is then put into the message.
bool Read(const std::string& text, v1::Cut& cut) {
  if (text == kAutomatic) return true;
  const size_t colon = text.find(':');
  if (colon == std::string::npos) return false;
  const std::string kind = text.substr(0, colon);
  const std::string value = text.substr(colon + 1);
  uint32_t count = 0;
  double salience = 0;
  if (kind == "level" && ReadWholeNumber(value, count)) {
    cut.set_level(count);
  } else if (kind == "segments" && ReadWholeNumber(value, count)) {
    cut.set_segments(count);
  } else if (kind == "salience" && ReadNumber(value, salience)) {
    cut.set_salience(salience);
  } else {
    return false;
  }
  return true;
}

}  // namespace

std::string CheckCutText(const std::string& text) {
  v1::Cut ignored;
  return Read(text, ignored)
             ? ""
             : absl::StrCat("'", text,
                            "' is no cut; allowed are auto, level:N, "
                            "segments:N and salience:X");
}

v1::Cut ToMessage(const CutChoice& choice) {
  v1::Cut cut;
  Read(choice.text, cut);
  cut.mutable_closed()->Add(choice.closed.begin(), choice.closed.end());
  cut.mutable_open()->Add(choice.open.begin(), choice.open.end());
  return cut;
}

}  // namespace marrow::client
