#include "tests/bench/bench_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/mesh_file/mesh_file.h"
#include "client/samples/samples.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

DecodedMesh ToDecoded(const PolygonMesh& mesh) {
  DecodedMesh decoded;
  decoded.positions.resize(mesh.NumVertices(), 3);
  for (size_t v = 0; v < mesh.NumVertices(); ++v)
    for (int i = 0; i < 3; ++i) decoded.positions(v, i) = mesh.positions[v][i];
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto face = mesh.Face(f);
    for (size_t corner = 2; corner < face.size(); ++corner)
      decoded.faces.push_back({face[0], face[corner - 1], face[corner]});
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

// How often a mesh of so many vertices has to be subdivided to come nearest.
int Subdivisions(double have, double want) {
  return want <= have ? 0
                      : static_cast<int>(
                            std::lround(std::log(want / have) / std::log(4.0)));
}

std::vector<std::string> FilesIn(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

absl::StatusOr<BenchMesh> Finish(std::string name, DecodedMesh mesh,
                                 int subdivisions) {
  for (int i = 0; i < subdivisions; ++i) mesh = Subdivide(mesh);
  if (subdivisions > 0)
    name += absl::StrCat(", ", subdivisions, " subdivision",
                         subdivisions > 1 ? "s" : "");
  MARROW_ASSIGN_OR_RETURN(CanonicalMesh canonical, Canonicalize(mesh));
  return BenchMesh{std::move(name), std::move(canonical)};
}

absl::StatusOr<BenchMesh> PickSample(uint32_t vertices) {
  constexpr char kSample[] = "humanoid";
  const double most = kMaxSampleFaces / 2;
  int subdivisions = 0;
  while (vertices > most * std::pow(4, subdivisions)) ++subdivisions;
  const double coarse = vertices / std::pow(4, subdivisions);
  MARROW_ASSIGN_OR_RETURN(
      const Sample sample,
      MakeSample(kSample, "",
                 std::max(kMinSampleFaces, static_cast<uint32_t>(2 * coarse))));
  return Finish(kSample, ToDecoded(sample.mesh), subdivisions);
}

}  // namespace

absl::StatusOr<CanonicalMesh> MakeSampleMesh(const std::string& name,
                                             uint32_t faces) {
  const bool subdivide = faces > kMaxSampleFaces;
  MARROW_ASSIGN_OR_RETURN(const Sample sample,
                          MakeSample(name, "", subdivide ? faces / 4 : faces));
  const DecodedMesh decoded = ToDecoded(sample.mesh);
  return Canonicalize(subdivide ? Subdivide(decoded) : decoded);
}

absl::StatusOr<BenchMesh> PickMesh(const std::string& path, uint32_t vertices) {
  if (path.empty()) return PickSample(vertices);
  std::string best_name;
  PolygonMesh best;
  double best_distance = HUGE_VAL;
  for (const std::string& file : FilesIn(path)) {
    absl::StatusOr<PolygonMesh> mesh = ReadMeshFile(file);
    if (!mesh.ok() && file == path) return mesh.status();
    if (!mesh.ok()) continue;
    const double have = static_cast<double>(mesh->NumVertices());
    const double comes_to = have * std::pow(4, Subdivisions(have, vertices));
    const double distance =
        vertices == 0 ? 0 : std::abs(std::log(comes_to / vertices));
    if (distance >= best_distance) continue;
    best_distance = distance;
    best_name = std::filesystem::path(file).filename().string();
    best = *std::move(mesh);
  }
  if (best_name.empty())
    return absl::NotFoundError(absl::StrCat(path, ": there is no mesh in it"));
  return Finish(
      best_name, ToDecoded(best),
      Subdivisions(static_cast<double>(best.NumVertices()), vertices));
}

}  // namespace marrow
