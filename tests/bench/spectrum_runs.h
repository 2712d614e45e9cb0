// The eigensolvers that `./dev bench spectrum` compares, one run a process.
#ifndef MARROW_TESTS_BENCH_SPECTRUM_RUNS_H_
#define MARROW_TESTS_BENCH_SPECTRUM_RUNS_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "absl/status/statusor.h"

namespace marrow {

// Writes what all solvers read into `folder`: L by columns as
// `starts.i32`, `rows.i32` and `values.f64`, M as `mass.f64`, and the canonical
// mesh as `positions.f64` and `faces.i32`, all packed little-endian. The value
// tells `mesh`, `vertices` and `faces`.
absl::StatusOr<nlohmann::json> WriteProblem(const std::string& path,
                                            uint32_t vertices,
                                            const std::string& folder);

// Solves what is in `folder` for `pairs` pairs besides the constant one by
// `solver`, "marrow", "strict" or "spectra". The value tells `seconds` from
// the matrices to the pairs, `peak_bytes` of the process until then,
// `residual`, the largest of the vectors that came out, and the `eigenvalues`.
absl::StatusOr<nlohmann::json> RunSolver(const std::string& solver,
                                         const std::string& folder,
                                         uint32_t pairs);

// How many eigenvalues of what is in `folder` are below `bound`, by the signs
// of a factorisation from Eigen, none of ours: `count`.
absl::StatusOr<nlohmann::json> CountBelow(const std::string& folder,
                                          double bound);

}  // namespace marrow

#endif  // MARROW_TESTS_BENCH_SPECTRUM_RUNS_H_
