// The paper's promise on the creatures whose parts are known: every limb is
// found, and found again in every pose.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/samples/samples.h"
#include "core/base/cancel_token.h"
#include "core/hierarchy/tree_builder.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/laplacian.h"
#include "core/pipeline/options.h"
#include "core/spectrum/solver.h"

namespace marrow {
namespace {

constexpr double kLeastOverlap = 0.7;
constexpr double kMostDisagreement = 0.05;

using Labels = std::vector<uint32_t>;  // a face of the sample

// What Marrow makes of a sample at its defaults.
struct Levels {
  std::array<Labels, 2> labels;  // of levels 1 and 2
  std::vector<double> areas;     // a face of the sample
};

DecodedMesh ToDecoded(const PolygonMesh& mesh) {
  DecodedMesh decoded;
  decoded.positions.resize(mesh.NumVertices(), 3);
  for (size_t v = 0; v < mesh.NumVertices(); ++v) {
    for (int i = 0; i < 3; ++i) decoded.positions(v, i) = mesh.positions[v][i];
  }
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    const auto corners = mesh.Face(f);
    decoded.faces.push_back({corners[0], corners[1], corners[2]});
  }
  return decoded;
}

Levels Segment(const PolygonMesh& mesh) {
  const CanonicalMesh canonical = Canonicalize(ToDecoded(mesh)).value();
  const SegmentationOptions defaults;
  const CancelToken cancel;
  SolverEigenPairSource source;
  const auto pairs =
      source.Get(canonical, defaults.eigen_pairs, cancel, nullptr).value();
  const Adjacency adjacency(canonical.mesh);
  const std::vector<double> areas = FaceAreaShares(canonical.mesh);
  TreeBuilder builder({canonical.mesh, adjacency, *pairs, areas},
                      defaults.split, canonical.report.area);
  Levels levels;
  for (uint32_t level = 1; level <= levels.labels.size(); ++level) {
    EXPECT_TRUE(builder.Deepen(cancel, nullptr).ok());
    const Labels found = builder.tree().FaceSegments(level);
    for (const uint32_t f : canonical.face_map)
      levels.labels[level - 1].push_back(found[f]);
  }
  for (const uint32_t f : canonical.face_map) levels.areas.push_back(areas[f]);
  return levels;
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

void ExpectLimbs(const Sample& sample, const Levels& levels) {
  for (uint32_t part = 1; part < sample.part_names.size(); ++part) {
    double best = 0;
    for (const Labels& labels : levels.labels)
      best = std::max(best, OverlapOf(part, sample, labels, levels.areas));
    EXPECT_GE(best, kLeastOverlap) << sample.part_names[part];
  }
}

// The share of pairs of faces that one labelling joins and the other parts.
double RandIndexError(const Labels& a, const Labels& b) {
  std::map<std::pair<uint32_t, uint32_t>, double> both;
  std::map<uint32_t, double> in_a, in_b;
  for (size_t f = 0; f < a.size(); ++f) {
    ++both[{a[f], b[f]}];
    ++in_a[a[f]];
    ++in_b[b[f]];
  }
  const auto squares = [](const auto& counts) {
    double sum = 0;
    for (const auto& [key, count] : counts) sum += count * count;
    return sum;
  };
  const double n = static_cast<double>(a.size());
  return (squares(in_a) + squares(in_b) - 2 * squares(both)) / (n * n - n);
}

class LimbsTest : public ::testing::TestWithParam<SampleInfo> {};

INSTANTIATE_TEST_SUITE_P(Samples, LimbsTest, ::testing::ValuesIn(ListSamples()),
                         [](const auto& info) { return info.param.name; });

TEST_P(LimbsTest, AreFoundAndFoundAgainInEveryPose) {
  std::vector<Labels> first_levels;
  for (const std::string& pose : GetParam().poses) {
    SCOPED_TRACE(pose);
    const Sample sample = MakeSample(GetParam().name, pose, 5000).value();
    Levels levels = Segment(sample.mesh);
    ExpectLimbs(sample, levels);
    for (size_t i = 0; i < first_levels.size(); ++i) {
      EXPECT_LE(RandIndexError(levels.labels[0], first_levels[i]),
                kMostDisagreement)
          << "with " << GetParam().poses[i];
    }
    first_levels.push_back(std::move(levels.labels[0]));
  }
}

TEST_P(LimbsTest, AreFoundOnAFineMesh) {
  const Sample sample = MakeSample(GetParam().name, "rest", 20000).value();
  ExpectLimbs(sample, Segment(sample.mesh));
}

TEST(RandIndexErrorTest, CountsThePairsThatAreApartInOneAlone) {
  EXPECT_EQ(RandIndexError({0, 0, 1, 1}, {7, 7, 3, 3}), 0);
  // Three of the six pairs: faces 0 and 2, 1 and 2, 2 and 3.
  EXPECT_NEAR(RandIndexError({0, 0, 1, 1}, {0, 0, 0, 1}), 0.5, 1e-12);
}

}  // namespace
}  // namespace marrow
