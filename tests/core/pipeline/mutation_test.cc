// Good meshes, damaged at random: whatever comes of them is sound, or is
// refused with a reason. MARROW_MUTATIONS is how many, MARROW_MUTATION_SEED
// the first seed: a failure names its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

#include "core/base/error_reason.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/solver.h"
#include "tests/testing/draco_encode.h"
#include "tests/testing/invariants.h"
#include "tests/testing/mutations.h"
#include "tests/testing/recording_sink.h"

namespace marrow {
namespace {

uint32_t FromEnvironment(const char* name, uint32_t otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : static_cast<uint32_t>(std::atoi(value));
}

// What a pair promises, tested on an operator of the test's own.
void ExpectSoundPairs(const CanonicalMesh& mesh, const EigenPairs& pairs) {
  const Eigen::VectorXd& lambda = pairs.eigenvalues;
  ASSERT_TRUE(lambda.allFinite());
  ASSERT_TRUE(pairs.eigenvectors.allFinite());
  EXPECT_EQ(lambda[0], 0);
  EXPECT_TRUE(std::is_sorted(lambda.begin(), lambda.end()));
  if (lambda.size() > 1) {
    EXPECT_GT(lambda[1], 0) << "the mesh is one body";
  }
  const Laplacian laplacian = BuildLaplacian(mesh.mesh).value();
  ASSERT_GT(laplacian.M.minCoeff(), 0);
  const Eigen::MatrixXd Phi = pairs.eigenvectors.cast<double>();
  const Eigen::MatrixXd gram =
      Phi.transpose() * laplacian.M.asDiagonal() * Phi -
      Eigen::MatrixXd::Identity(Phi.cols(), Phi.cols());
  EXPECT_LE(gram.cwiseAbs().maxCoeff(), kSolverTolerance / 4);
  // Vectors are stored as floats: what rounding adds to a Rayleigh quotient is
  // its square times the largest eigenvalue, which Gershgorin bounds.
  const double largest = 2 * Eigen::VectorXd(laplacian.L.diagonal())
                                 .cwiseQuotient(laplacian.M)
                                 .maxCoeff();
  for (Eigen::Index k = 1; k < Phi.cols(); ++k) {
    const double quotient = Phi.col(k).dot(laplacian.L * Phi.col(k));
    EXPECT_NEAR(quotient, lambda[k], 1e-4 * lambda[k] + 1e-14 * largest)
        << "pair " << k;
  }
}

// The solver, with its answer looked at.
class CheckedSource : public EigenPairSource {
 public:
  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    auto pairs = solver_.Get(mesh, count, cancel, progress);
    if (pairs.ok()) ExpectSoundPairs(mesh, **pairs);
    return pairs;
  }

 private:
  SolverEigenPairSource solver_;
};

void ExpectSoundRun(const RecordingSink& run, const TriangleMesh& payload,
                    Method method) {
  const TriangleMesh& mesh = run.mesh.mesh;
  const Adjacency adjacency(mesh);
  ExpectSoundTree(mesh, adjacency, run.tree, run.mesh.report.area, true,
                  method == Method::kMerge);
  for (const auto& level : run.levels) {
    ExpectSoundSkeleton(mesh, adjacency, run.tree, level.level, level.skeleton);
    const auto segments = run.tree.FaceSegments(level.level);
    ASSERT_EQ(level.face_labels.size(), payload.NumFaces());
    ASSERT_EQ(level.point_labels.size(), payload.NumVertices());
    for (size_t f = 0; f < level.face_labels.size(); ++f)
      ASSERT_EQ(level.face_labels[f], segments[run.mesh.face_map[f]]);
  }
}

// Returns what came of it: "segmented" or why it was refused.
std::string TryMutation(const Mutation& mutation, Method method) {
  // Small meshes take the dense solver; fewer pairs let some take the other.
  SegmentationOptions options;
  options.method = method;
  options.eigen_pairs = 60;
  CheckedSource source;
  const CancelToken cancel;
  RecordingSink run;
  const absl::Status status =
      Run(EncodeDraco(mutation.mesh, Precision::kDouble), MeshLimits(), options,
          source, cancel, run);
  if (status.ok()) {
    EXPECT_FALSE(mutation.has_nan);
    ExpectSoundRun(run, mutation.mesh, method);
    return "segmented";
  }
  const std::string reason = ReasonOf(status);
  // The damage leaves everything within what Draco carries, but that there may
  // be too few faces for the vertices.
  EXPECT_TRUE(reason == kReasonMeshRejected ||
              (reason == kReasonDracoDecodeFailed &&
               mutation.mesh.NumVertices() > 3 * mutation.mesh.NumFaces()))
      << status;
  return reason;
}

TEST(MutationTest, DamageIsAnsweredOrRefused) {
  const uint32_t first = FromEnvironment("MARROW_MUTATION_SEED", 1);
  const uint32_t count = FromEnvironment("MARROW_MUTATIONS", 200);
  std::map<std::string, uint32_t> ends;
  for (uint32_t seed = first; seed < first + count; ++seed) {
    const Mutation mutation = MakeMutation(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + mutation.history);
    ++ends[TryMutation(mutation,
                       seed % 2 == 0 ? Method::kMerge : Method::kPaper)];
    if (seed % 500 == 0) std::cerr << seed << " seeds\n";
  }
  for (const auto& [end, times] : ends)
    std::cout << end << ": " << times << "\n";
  // Most damage is no reason to refuse.
  EXPECT_GE(ends["segmented"], 0.7 * count);
}

}  // namespace
}  // namespace marrow
