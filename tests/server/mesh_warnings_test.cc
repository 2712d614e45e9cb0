#include "server/mesh_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace marrow {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

MeshReport CleanReport() {
  MeshReport report;
  report.components = 1;
  report.box_min = Eigen::Vector3d(-1, 0, 0);
  report.box_max = Eigen::Vector3d(1, 1, 1);
  return report;
}

TEST(MeshWarningsTest, ACleanMeshHasNone) {
  MeshReport report = CleanReport();
  report.boundary_edges = 7;
  report.welded_points = 9;
  EXPECT_THAT(WarningsAbout(report), IsEmpty());
}

struct Flaw {
  const char* code;
  const char* says;
  std::function<void(MeshReport&)> make;
};

class FlawTest : public ::testing::TestWithParam<Flaw> {};

TEST_P(FlawTest, IsTold) {
  MeshReport report = CleanReport();
  GetParam().make(report);
  const std::vector<v1::Warning> warnings = WarningsAbout(report);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code(), GetParam().code);
  EXPECT_THAT(warnings[0].message(), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    All, FlawTest,
    ::testing::Values(Flaw{"COMPONENTS_BRIDGED", "in 12 pieces",
                           [](MeshReport& r) { r.components = 12; }},
                      Flaw{"DEGENERATE_FACES", "3 faces have two corners",
                           [](MeshReport& r) { r.degenerate_faces = 3; }},
                      Flaw{"DUPLICATE_FACES", "1 face has the same corners",
                           [](MeshReport& r) { r.duplicate_faces = 1; }},
                      Flaw{"NONMANIFOLD_EDGES",
                           "2 edges have more than two faces",
                           [](MeshReport& r) { r.nonmanifold_edges = 2; }},
                      Flaw{"UNUSED_POINTS", "1 point is in no face",
                           [](MeshReport& r) { r.unused_points = 1; }},
                      Flaw{"FAR_FROM_ORIGIN", "times its own size",
                           [](MeshReport& r) {
                             r.box_min.x() += 1e6;
                             r.box_max.x() += 1e6;
                           }}),
    [](const auto& info) { return std::string(info.param.code); });

TEST(MeshWarningsTest, EachFlawIsToldOnItsOwn) {
  MeshReport report = CleanReport();
  report.components = 2;
  report.unused_points = 5;
  EXPECT_THAT(WarningsAbout(report), SizeIs(2));
}

}  // namespace
}  // namespace marrow
