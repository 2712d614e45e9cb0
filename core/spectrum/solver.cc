// Everything is solved in the symmetric form: with D = M^-1/2, the pairs of
// A = D L D are (lambda, y), and phi = D y. The residual of y in the Euclidean
// norm is that of phi in the M^-1 norm.
#include "core/spectrum/solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/reference_solver.h"
#include "core/spectrum/slicing.h"

namespace marrow {
namespace {

// Up to this size a dense solver is quicker, and always finds everything.
constexpr int kDenseVertices = 500;
// The reference solver is no way out above this size: it would take hours.
constexpr int kReferenceVertices = 200'000;
// Pairs are certified up to this count for a mesh of n vertices; above it the
// dense solver has to do.
constexpr double kSlicedShare = 0.5;

struct SymmetricProblem {
  Eigen::SparseMatrix<double> A;
  Eigen::VectorXd inverse_sqrt_mass;
};

absl::StatusOr<SymmetricProblem> MakeProblem(const TriangleMesh& mesh,
                                             const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian,
                          BuildLaplacian(mesh, cancel));
  SymmetricProblem problem;
  problem.inverse_sqrt_mass = laplacian.M.cwiseSqrt().cwiseInverse();
  problem.A = problem.inverse_sqrt_mass.asDiagonal() * laplacian.L *
              problem.inverse_sqrt_mass.asDiagonal();
  return problem;
}

// All that is not the constant pair is orthogonal to it, which the dense solver
// leaves to rounding: too much where masses differ by many orders.
void RemoveConstant(const Eigen::VectorXd& inverse_sqrt_mass,
                    MatrixPairs& raw) {
  const Eigen::VectorXd constant =
      inverse_sqrt_mass.cwiseInverse().normalized();
  for (Eigen::Index k = 1; k < raw.vectors.cols(); ++k) {
    raw.vectors.col(k) -= constant.dot(raw.vectors.col(k)) * constant;
    raw.vectors.col(k).normalize();
  }
}

// The entry of largest magnitude (the first, where several are) is positive,
// and the constant pair, which is known exactly, is exact.
void Finish(EigenPairs& pairs) {
  EigenvectorMatrix& vectors = pairs.eigenvectors;
  const Eigen::Index count = vectors.cols();
  Eigen::RowVectorXf largest = Eigen::RowVectorXf::Zero(count);
  for (Eigen::Index v = 0; v < vectors.rows(); ++v)
    for (Eigen::Index k = 0; k < count; ++k)
      if (std::abs(vectors(v, k)) > std::abs(largest[k]))
        largest[k] = vectors(v, k);
  const Eigen::RowVectorXf sign =
      (largest.array() < 0)
          .select(Eigen::RowVectorXf::Constant(count, -1),
                  Eigen::RowVectorXf::Ones(count));
  for (Eigen::Index v = 0; v < vectors.rows(); ++v)
    vectors.row(v) = vectors.row(v).cwiseProduct(sign);
  vectors.col(0).setOnes();
  pairs.eigenvalues[0] = 0;
}

void Assign(const MatrixPairs& raw, const Eigen::VectorXd& scale,
            EigenPairs& pairs) {
  pairs.eigenvalues = raw.values;
  pairs.eigenvectors = (scale.asDiagonal() * raw.vectors).cast<float>();
}

void Assign(SlicedSpectrum raw, const Eigen::VectorXd& scale, int count,
            EigenPairs& pairs) {
  pairs.eigenvalues.resize(count);
  pairs.eigenvectors.resize(scale.size(), count);
  int column = 0;
  for (SlicedSpectrum::Part& part : raw.parts) {
    const int stride = static_cast<int>(part.band.values.size());
    const int width = part.end - part.first;
    for (int k = 0; k < width; ++k)
      pairs.eigenvalues[column + k] = part.band.values[part.first + k];
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      const int v = raw.order[i];
      const float* row = part.band.vectors.data() + i * stride + part.first;
      for (int k = 0; k < width; ++k)
        pairs.eigenvectors(v, column + k) =
            static_cast<float>(row[k] * scale[v]);
    }
    part.band.vectors = {};
    column += width;
  }
}

absl::Status SolveSparse(const TriangleMesh& mesh,
                         const SymmetricProblem& problem, int count,
                         double tolerance, const CancelToken& cancel,
                         const ProgressCallback& progress, EigenPairs& pairs) {
  const auto report = [&](double share) {
    if (progress) progress(0.95 * share);
  };
  SlicingOptions options;
  options.threads = static_cast<int>(
      std::clamp(std::thread::hardware_concurrency(), 1u, 2u));
  absl::StatusOr<SlicedSpectrum> sliced =
      SliceSpectrum(problem.A, mesh.positions.data(), count, options, cancel,
                    report);
  if (sliced.ok()) {
    Assign(*std::move(sliced), problem.inverse_sqrt_mass, count, pairs);
    return absl::OkStatus();
  }
  if (sliced.status().code() != absl::StatusCode::kInternal ||
      mesh.NumVertices() > kReferenceVertices)
    return sliced.status();
  MARROW_ASSIGN_OR_RETURN(
      const MatrixPairs raw,
      SolveByReference(problem.A, count, cancel, [](double) {}));
  Assign(raw, problem.inverse_sqrt_mass, pairs);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::shared_ptr<const EigenPairs>> SolverEigenPairSource::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  MARROW_RETURN_IF_ERROR(cancel.Check());
  const int n = static_cast<int>(mesh.mesh.NumVertices());
  const int pairs = std::min(static_cast<int>(count) + 1, n);
  MARROW_ASSIGN_OR_RETURN(const SymmetricProblem problem,
                          MakeProblem(mesh.mesh, cancel));
  MARROW_RETURN_IF_ERROR(cancel.Check());
  auto result = std::make_shared<EigenPairs>();
  if (n <= kDenseVertices || pairs > kSlicedShare * n) {
    MatrixPairs raw = SolveDensely(problem.A, pairs);
    RemoveConstant(problem.inverse_sqrt_mass, raw);
    Assign(raw, problem.inverse_sqrt_mass, *result);
  } else {
    MARROW_RETURN_IF_ERROR(SolveSparse(mesh.mesh, problem, pairs, tolerance_,
                                       cancel, progress, *result));
  }
  Finish(*result);
  result->area = mesh.report.area;
  result->complete = pairs == n;
  if (progress) progress(1);
  return result;
}

double PredictSolverSeconds(uint64_t vertices, uint32_t count) {
  const double n = static_cast<double>(vertices);
  return 0.02 + n * (1.6e-7 * count + 4e-6);
}

uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count) {
  // The pairs, once in bands and once as a whole; two threads' bases and
  // factors; the matrix.
  return vertices * (sizeof(float) * 2 * (uint64_t{count} + 1) + 4096);
}

}  // namespace marrow
