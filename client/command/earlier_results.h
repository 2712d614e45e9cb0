// What earlier runs left behind, by what they themselves say.
#ifndef MARROW_CLIENT_COMMAND_EARLIER_RESULTS_H_
#define MARROW_CLIENT_COMMAND_EARLIER_RESULTS_H_

#include <string>
#include <vector>

namespace marrow::client {

// Names, without folder and sorted, of the files that STEM.json and
// STEM.cut.json in `folder` say were written with them, each once, whether they
// are still there or not. Nothing that has no name of a result of STEM; empty
// where neither file is Marrow's.
std::vector<std::string> EarlierResults(const std::string& folder,
                                        const std::string& stem);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_EARLIER_RESULTS_H_
