#include "core/mesh/submesh.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

TEST(SubmeshTest, IsWhatAFileOfTheFacesAloneGives) {
  const TriangleMesh left = LimbCross(2), right = Icosphere(2);
  const TriangleMesh both = Apart(left, right);
  const CanonicalMesh whole = CanonicalOf(both);
  std::vector<uint32_t> faces;
  for (uint32_t f = 0; f < left.NumFaces(); ++f)
    faces.push_back(whole.face_map[f]);
  std::sort(faces.begin(), faces.end());
  const Submesh part = ExtractFaces(whole.mesh, faces);
  const CanonicalMesh alone = CanonicalOf(left);
  EXPECT_EQ(part.canonical.geometry_digest, alone.geometry_digest);
  EXPECT_EQ(part.canonical.report.area, alone.report.area);
  EXPECT_EQ(part.canonical.report.components, 1u);
  ASSERT_EQ(part.vertices.size(), alone.mesh.NumVertices());
  for (uint32_t v = 0; v < part.vertices.size(); ++v)
    EXPECT_EQ(whole.mesh.Position(part.vertices[v]), alone.mesh.Position(v));
}

TEST(SubmeshTest, OfAllFacesIsTheMesh) {
  const CanonicalMesh whole = CanonicalOf(Torus(3, 1, 12, 8));
  std::vector<uint32_t> faces(whole.mesh.NumFaces());
  std::iota(faces.begin(), faces.end(), 0u);
  const Submesh part = ExtractFaces(whole.mesh, faces);
  EXPECT_EQ(part.canonical.geometry_digest, whole.geometry_digest);
  EXPECT_EQ(part.canonical.report.genus, 1u);
}

}  // namespace
}  // namespace marrow
