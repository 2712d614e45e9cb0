#include "client/unused_vertices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace marrow::client {
namespace {

using ::testing::HasSubstr;

TEST(UnusedVerticesTest, TellsOfThoseThatTheServerDidNotSee) {
  v1::MeshReport report;
  report.add_findings()->set_code("BOUNDARIES");
  EXPECT_TRUE(CountUnusedVertices(2, report));
  EXPECT_EQ(report.unused_points(), 2u);
  ASSERT_EQ(report.findings_size(), 2);
  EXPECT_EQ(report.findings(1).code(), "UNUSED_POINTS");
  EXPECT_EQ(report.findings(1).count(), 2u);
  EXPECT_THAT(report.findings(1).message(), HasSubstr("2 vertices are in no"));
  EXPECT_EQ(UnusedVerticesWarning(1).code(), "UNUSED_POINTS");
  EXPECT_THAT(UnusedVerticesWarning(1).message(), HasSubstr("1 vertex is in"));
}

TEST(UnusedVerticesTest, LeavesAReportThatCountsThem) {
  for (const uint32_t count : {0, 3}) {
    v1::MeshReport report;
    report.set_unused_points(count);
    EXPECT_FALSE(CountUnusedVertices(count, report));
    EXPECT_EQ(report.unused_points(), count);
    EXPECT_EQ(report.findings_size(), 0);
  }
}

}  // namespace
}  // namespace marrow::client
