// Numbers as people type them.
#ifndef MARROW_CLIENT_COMMAND_NUMBER_TEXT_H_
#define MARROW_CLIENT_COMMAND_NUMBER_TEXT_H_

#include <cstdint>
#include <string>

namespace marrow::client {

// Decimal digits alone, without zeros before them. False where the text is
// anything else or too large.
bool ReadWholeNumber(const std::string& text, uint32_t& value);

// A finite decimal number, such as -1, .5 or 1e-3; neither blanks nor
// hexadecimal digits. False where the text is anything else.
bool ReadNumber(const std::string& text, double& value);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_NUMBER_TEXT_H_
