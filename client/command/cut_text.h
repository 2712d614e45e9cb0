// What --cut, --closed and --open say.
#ifndef MARROW_CLIENT_COMMAND_CUT_TEXT_H_
#define MARROW_CLIENT_COMMAND_CUT_TEXT_H_

#include <string>

#include "client/command/arguments.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

// Empty for auto, level:N, segments:N and salience:X, where N is a whole and X
// any number, as number_text.h reads them; else what is wrong and what is
// allowed. Ranges are the server's business.
std::string CheckCutText(const std::string& text);

// REQUIRES: CheckCutText(choice.text) is empty.
v1::Cut ToMessage(const CutChoice& choice);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_CUT_TEXT_H_
