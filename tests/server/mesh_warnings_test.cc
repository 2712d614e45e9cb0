#include "server/mesh_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/operators/bodies.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::StartsWith;

MeshReport CleanReport() {
  MeshReport report;
  report.components = report.bodies = 1;
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

TEST(FindingsTest, TellOfMoreThanWarnings) {
  MeshReport report = CleanReport();
  EXPECT_THAT(FindingsAbout(report), IsEmpty());
  report.welded_points = 9;
  report.boundary_loops = 1;
  report.sliver_faces = 2;
  report.flipped_faces = 3;
  report.degenerate_faces = 4;
  const std::vector<v1::Finding> findings = FindingsAbout(report);
  std::vector<std::pair<std::string, uint32_t>> counts;
  for (const v1::Finding& finding : findings) {
    counts.push_back({finding.code(), finding.count()});
    EXPECT_THAT(finding.message(), StartsWith(std::to_string(finding.count())));
  }
  EXPECT_THAT(counts,
              ElementsAre(Pair("WELDED_POINTS", 9), Pair("DEGENERATE_FACES", 4),
                          Pair("SLIVER_FACES", 2), Pair("FLIPPED_FACES", 3),
                          Pair("BOUNDARIES", 1)));
  EXPECT_THAT(WarningsAbout(report), SizeIs(1));
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
    ::testing::Values(Flaw{"COMPONENTS_BRIDGED", "12 components are so near",
                           [](MeshReport& r) { r.bridged_components = 12; }},
                      Flaw{"COMPONENTS_ATTACHED", "1 component is too small",
                           [](MeshReport& r) { r.attached_components = 1; }},
                      Flaw{"INNER_WALL_FACES", "2 faces are inside",
                           [](MeshReport& r) { r.inner_wall_faces = 2; }},
                      Flaw{"SEVERAL_BODIES",
                           "the mesh is 3 bodies, apart from each other or one "
                           "the surroundings of others; each is segmented on "
                           "its own",
                           [](MeshReport& r) { r.bodies = 3; }},
                      Flaw{"DEGENERATE_FACES", "3 faces have two corners",
                           [](MeshReport& r) { r.degenerate_faces = 3; }},
                      Flaw{"DUPLICATE_FACES", "1 face has the same corners",
                           [](MeshReport& r) { r.duplicate_faces = 1; }},
                      Flaw{"NONMANIFOLD_EDGES",
                           "2 edges have more than two faces",
                           [](MeshReport& r) { r.nonmanifold_edges = 2; }},
                      Flaw{"UNUSED_POINTS", "1 point is in no face",
                           [](MeshReport& r) { r.unused_points = 1; }},
                      Flaw{"FAR_FROM_ORIGIN",
                           "times its own size away from the origin, where "
                           "coordinates of single precision have few digits",
                           [](MeshReport& r) {
                             r.box_min.x() += 1e6;
                             r.box_max.x() += 1e6;
                           }}),
    [](const auto& info) { return std::string(info.param.code); });

// The message of COMPONENTS_ATTACHED.
std::string AttachedMessage(uint64_t bodies, uint64_t attached) {
  MeshReport report = CleanReport();
  report.bodies = bodies;
  report.attached_components = attached;
  for (const v1::Warning& warning : WarningsAbout(report))
    if (warning.code() == "COMPONENTS_ATTACHED") return warning.message();
  return "";
}

TEST(MeshWarningsTest, WhatIsBeyondTheLastBodyIsNotCalledTooSmall) {
  EXPECT_EQ(AttachedMessage(kMaxBodies - 1, 2),
            "2 components are too small to be segmented, and have the label of "
            "the nearest part");
  EXPECT_EQ(AttachedMessage(kMaxBodies, 2),
            "2 components are too small to be segmented, or beyond the 128 "
            "largest bodies, and have the label of the nearest part");
  EXPECT_EQ(AttachedMessage(kMaxBodies, 1),
            "1 component is too small to be segmented, or beyond the 128 "
            "largest bodies, and has the label of the nearest part");
}

TEST(MeshWarningsTest, EachFlawIsToldOnItsOwn) {
  MeshReport report = CleanReport();
  report.attached_components = 2;
  report.unused_points = 5;
  EXPECT_THAT(WarningsAbout(report), SizeIs(2));
}

}  // namespace
}  // namespace marrow
