// The paper's Table 1 on meshes of the same sizes, as a Markdown table.
//
// The paper's models are not free to pass on, so each row is a sample creature
// of that many vertices; those above 25k vertices are subdivided once, every
// face into four.
#include <Eigen/Core>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "client/samples/samples.h"
#include "core/hierarchy/tree_builder.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"

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

DecodedMesh ToDecoded(const PolygonMesh& mesh) {
  DecodedMesh decoded;
  decoded.positions.resize(mesh.NumVertices(), 3);
  for (size_t v = 0; v < mesh.NumVertices(); ++v)
    for (int i = 0; i < 3; ++i) decoded.positions(v, i) = mesh.positions[v][i];
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto face = mesh.Face(f);
    decoded.faces.push_back({face[0], face[1], face[2]});
  }
  return decoded;
}

DecodedMesh Subdivide(const DecodedMesh& mesh) {
  DecodedMesh fine;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middle;
  uint32_t next = static_cast<uint32_t>(mesh.positions.rows());
  auto between = [&](uint32_t a, uint32_t b) {
    const auto [it, is_new] = middle.emplace(std::minmax(a, b), next);
    next += is_new;
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.faces) {
    const uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
    fine.faces.insert(fine.faces.end(),
                      {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  fine.positions.resize(next, 3);
  fine.positions.topRows(mesh.positions.rows()) = mesh.positions;
  for (const auto& [ends, v] : middle)
    fine.positions.row(v) = 0.5 * (mesh.positions.row(ends.first) +
                                   mesh.positions.row(ends.second));
  return fine;
}

double Seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since)
      .count();
}

// The canonical mesh of a sample with about that many faces.
absl::StatusOr<CanonicalMesh> MakeMesh(const Row& row) {
  const bool subdivide = row.faces > kMaxSampleFaces;
  auto sample =
      MakeSample(row.sample, "", subdivide ? row.faces / 4 : row.faces);
  if (!sample.ok()) return sample.status();
  const DecodedMesh decoded = ToDecoded(sample->mesh);
  return Canonicalize(subdivide ? Subdivide(decoded) : decoded);
}

absl::Status Measure(const Row& row) {
  const auto canonical = MakeMesh(row);
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
  TreeBuilder builder({canonical->mesh, adjacency, **pairs, areas},
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

int Main() {
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

}  // namespace
}  // namespace marrow

int main() { return marrow::Main(); }
