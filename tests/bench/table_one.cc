#include "tests/bench/table_one.h"

#include <chrono>
#include <cstdio>

#include "core/hierarchy/tree_builder.h"
#include "core/mesh/adjacency.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "tests/bench/bench_mesh.h"

namespace marrow {
namespace {

struct Row {
  const char* paper_model;
  const char* sample;
  uint32_t faces;
  double paper_solver_seconds;
  double paper_level_seconds;
};

// Sizes and times are those of Table 1.
constexpr Row kRows[] = {
    {"dinopet", "humanoid", 8000, 2.7, 0.9},
    {"human", "humanoid", 16000, 7.4, 3.0},
    {"dog", "quadruped", 19000, 9.2, 4.7},
    {"armadillo", "humanoid", 46000, 23.7, 6.7},
    {"elephant", "quadruped", 84500, 46.6, 13.4},
    {"dinosaur", "octopus", 112000, 63.9, 29.9},
};

double Seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since)
      .count();
}

absl::Status Measure(const Row& row) {
  const auto canonical = MakeSampleMesh(row.sample, row.faces);
  if (!canonical.ok()) return canonical.status();
  const CancelToken cancel;
  auto start = std::chrono::steady_clock::now();
  const auto pairs =
      SolverEigenPairSource().Get(*canonical, 200, cancel, nullptr);
  if (!pairs.ok()) return pairs.status();
  const double solver = Seconds(start);

  start = std::chrono::steady_clock::now();
  const Adjacency adjacency(canonical->mesh);
  const auto areas = FaceAreaShares(canonical->mesh);
  const PulledPairs pulled{*pairs, (*pairs)->NumPairs() - 1};
  TreeBuilder builder({canonical->mesh, adjacency, pulled, areas},
                      SplitOptions(), canonical->report.area);
  const auto deeper = builder.Deepen(cancel, nullptr);
  if (!deeper.ok()) return deeper.status();
  std::printf("| %s | %s | %u | %u | %.2f | %.1f | %u | %.3f | %.1f |\n",
              row.paper_model, row.sample, canonical->mesh.NumVertices(),
              canonical->mesh.NumFaces(), solver, row.paper_solver_seconds,
              builder.tree().nodes[0].iterations, Seconds(start),
              row.paper_level_seconds);
  std::fflush(stdout);
  return absl::OkStatus();
}

}  // namespace

int PrintTableOne() {
  std::printf(
      "| paper's model | sample | vertices | faces | solver, s | paper's, s "
      "| iterations | level 1, s | paper's, s |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : kRows) {
    const absl::Status status = Measure(row);
    if (status.ok()) continue;
    std::fprintf(stderr, "marrow_bench: %s: %s\n", row.sample,
                 status.ToString().c_str());
    return 1;
  }
  return 0;
}

}  // namespace marrow
