#include "client/exporters/seg_file.h"

#include <gtest/gtest.h>

#include <vector>

namespace marrow {
namespace {

TEST(SegFileTest, WritesALabelALine) {
  const std::vector<uint32_t> labels = {3, 0, 4294967294u};
  EXPECT_EQ(SegFile(labels), "3\n0\n4294967294\n");
}

TEST(SegFileTest, IsEmptyWithoutFaces) { EXPECT_EQ(SegFile({}), ""); }

}  // namespace
}  // namespace marrow
