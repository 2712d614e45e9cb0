// What ./dev bench runs.
//
//   marrow_bench                                     the paper's Table 1
//   marrow_bench problem FOLDER VERTICES [PATH]      see spectrum_runs.h
//   marrow_bench solve SOLVER FOLDER PAIRS
//   marrow_bench count FOLDER BOUND
//
// All but the first print a line of JSON.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/numbers.h"
#include "tests/bench/spectrum_runs.h"
#include "tests/bench/table_one.h"

namespace marrow {
namespace {

absl::StatusOr<nlohmann::json> Run(const std::vector<std::string>& words) {
  uint32_t number = 0;
  double bound = 0;
  const std::string& verb = words[0];
  const size_t count = words.size();
  if (verb == "problem" && (count == 3 || count == 4) &&
      absl::SimpleAtoi(words[2], &number))
    return WriteProblem(count == 4 ? words[3] : "", number, words[1]);
  if (verb == "solve" && count == 4 && absl::SimpleAtoi(words[3], &number))
    return RunSolver(words[1], words[2], number);
  if (verb == "count" && count == 3 && absl::SimpleAtod(words[2], &bound))
    return CountBelow(words[1], bound);
  return absl::InvalidArgumentError(
      "say nothing, problem FOLDER VERTICES [PATH], solve SOLVER FOLDER PAIRS "
      "or count FOLDER BOUND");
}

int Main(const std::vector<std::string>& words) {
  if (words.empty()) return PrintTableOne();
  const absl::StatusOr<nlohmann::json> result = Run(words);
  if (!result.ok()) {
    std::fprintf(stderr, "marrow_bench: %s\n",
                 std::string(result.status().message()).c_str());
    return 1;
  }
  std::puts(result->dump().c_str());
  return 0;
}

}  // namespace
}  // namespace marrow

int main(int argc, char** argv) {
  return marrow::Main({argv + 1, argv + argc});
}
