// What both methods promise on the creatures whose parts are known: every limb
// is found, and found again in every pose.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "client/samples/samples.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/options.h"
#include "tests/testing/run.h"

namespace marrow {
namespace {

constexpr double kLeastOverlap = 0.7;
constexpr double kMostDisagreement = 0.05;

using Labels = std::vector<uint32_t>;  // a face of the sample

TriangleMesh ToTriangleMesh(const PolygonMesh& polygons) {
  TriangleMesh mesh;
  mesh.positions.resize(polygons.NumVertices(), 3);
  for (size_t v = 0; v < polygons.NumVertices(); ++v) {
    for (int i = 0; i < 3; ++i) mesh.positions(v, i) = polygons.positions[v][i];
  }
  for (size_t f = 0; f < polygons.NumFaces(); ++f) {
    const auto corners = polygons.Face(f);
    mesh.faces.push_back({corners[0], corners[1], corners[2]});
  }
  return mesh;
}

std::vector<double> AreasOf(const TriangleMesh& mesh) {
  std::vector<double> areas;
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3d p = mesh.positions.row(a);
    const Eigen::Vector3d q = mesh.positions.row(b);
    const Eigen::Vector3d r = mesh.positions.row(c);
    areas.push_back(0.5 * (q - p).cross(r - p).norm());
  }
  return areas;
}

// Levels 1 and 2 at the defaults.
std::array<Labels, 2> Segment(const Sample& sample, Method method) {
  SegmentationOptions options;
  options.method = method;
  options.levels = 2;
  const RecordingSink run = RunOn(ToTriangleMesh(sample.mesh), options);
  // Where pieces have no boundary of the second threshold there is one level.
  EXPECT_GE(run.levels.size(), method == Method::kPaper ? 2u : 1u);
  return {run.levels.at(0).face_labels, run.levels.back().face_labels};
}

// The greatest intersection over union, by area, of the part with a segment.
double OverlapOf(uint32_t part, const Sample& sample, const Labels& labels,
                 const std::vector<double>& areas) {
  std::map<uint32_t, double> both, whole;
  double part_area = 0;
  for (size_t f = 0; f < labels.size(); ++f) {
    whole[labels[f]] += areas[f];
    if (sample.face_parts[f] != part) continue;
    part_area += areas[f];
    both[labels[f]] += areas[f];
  }
  double best = 0;
  for (const auto& [label, area] : both)
    best = std::max(best, area / (part_area + whole[label] - area));
  return best;
}

void ExpectLimbs(const Sample& sample, const std::array<Labels, 2>& levels) {
  const std::vector<double> areas = AreasOf(ToTriangleMesh(sample.mesh));
  for (uint32_t part = 1; part < sample.part_names.size(); ++part) {
    double best = 0;
    for (const Labels& labels : levels)
      best = std::max(best, OverlapOf(part, sample, labels, areas));
    EXPECT_GE(best, kLeastOverlap) << sample.part_names[part];
  }
}

class LimbsTest
    : public ::testing::TestWithParam<std::tuple<SampleInfo, Method>> {
 protected:
  const SampleInfo& info() const { return std::get<0>(GetParam()); }
  Method method() const { return std::get<1>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(
    Samples, LimbsTest,
    ::testing::Combine(::testing::ValuesIn(ListSamples()),
                       ::testing::Values(Method::kPaper, Method::kMerge)),
    [](const auto& test) {
      return std::get<0>(test.param).name +
             (std::get<1>(test.param) == Method::kPaper ? "Paper" : "Merge");
    });

TEST_P(LimbsTest, AreFoundAndFoundAgainInEveryPose) {
  std::vector<Labels> first_levels;
  for (const std::string& pose : info().poses) {
    SCOPED_TRACE(pose);
    const Sample sample = MakeSample(info().name, pose, 5000).value();
    const std::array<Labels, 2> levels = Segment(sample, method());
    ExpectLimbs(sample, levels);
    for (size_t i = 0; i < first_levels.size(); ++i) {
      EXPECT_LE(RandIndexDifference(levels[0], first_levels[i]),
                kMostDisagreement)
          << "with " << info().poses[i];
    }
    first_levels.push_back(levels[0]);
  }
}

TEST_P(LimbsTest, AreFoundOnAFineMesh) {
  const Sample sample = MakeSample(info().name, "rest", 20000).value();
  ExpectLimbs(sample, Segment(sample, method()));
}

}  // namespace
}  // namespace marrow
