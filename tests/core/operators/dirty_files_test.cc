// The operator on meshes as they are found.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "client/mesh_file/mesh_file.h"
#include "client/mesh_file/triangulate.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/core/operators/guarantees.h"

namespace marrow {
namespace {

// Empty where a coordinate is no finite number.
DecodedMesh Load(const std::string& path) {
  const auto polygons = ReadMeshFile(path);
  EXPECT_TRUE(polygons.ok()) << polygons.status();
  DecodedMesh mesh;
  if (!polygons.ok()) return mesh;
  const auto& points = polygons->positions;
  mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (size_t v = 0; v < points.size(); ++v)
    for (int i = 0; i < 3; ++i)
      mesh.positions(static_cast<Eigen::Index>(v), i) = points[v][i];
  if (!mesh.positions.allFinite()) return DecodedMesh();
  for (size_t f = 0; f + 1 < polygons->face_offsets.size(); ++f)
    Triangulate(*polygons, f, &mesh.faces);
  return mesh;
}

TEST(DirtyFilesTest, HoldEveryGuarantee) {
  const char* data = std::getenv("MARROW_DATA");
  if (data == nullptr ||
      !std::filesystem::is_directory(std::filesystem::path(data) / "dirty"))
    GTEST_SKIP() << "set MARROW_DATA to a folder with dirty";
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(data) / "dirty")) {
    SCOPED_TRACE(entry.path().filename());
    const DecodedMesh decoded = Load(entry.path());
    if (decoded.faces.empty()) continue;
    const auto canonical = Canonicalize(decoded);
    if (!canonical.ok()) {
      EXPECT_EQ(entry.path().filename(), "degenerate_mesh.obj");
      continue;
    }
    const auto laplacian = BuildLaplacian(canonical->mesh);
    ASSERT_TRUE(laplacian.ok()) << laplacian.status();
    ExpectGuarantees(canonical->mesh, *laplacian);
    EXPECT_EQ(laplacian->report.nonmanifold_edges,
              canonical->report.nonmanifold_edges);
  }
}

}  // namespace
}  // namespace marrow
