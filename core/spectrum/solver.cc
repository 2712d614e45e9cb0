// Everything is solved in the symmetric form: with D = M^-1/2, the pairs of
// A = D L D are (lambda, y), and phi = D y. The residual of y in the Euclidean
// norm is that of phi in the M^-1 norm.
#include "core/spectrum/solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/dense_solver.h"
#include "core/spectrum/reference_solver.h"
#include "core/spectrum/separate_bands.h"
#include "core/spectrum/slicing.h"
#include "core/spectrum/team.h"

namespace marrow {
namespace {

// The reference solver is no way out above this size: it would take hours.
constexpr int kReferenceVertices = 200'000;
// Of the tolerance: pairs of smaller residuals overlap with those of other
// bands by next to nothing.
constexpr double kLooseShare = 1.0 / 16;
// What the analysis is of the whole.
constexpr double kAnalysisShare = 0.1;

struct SymmetricProblem {
  Eigen::SparseMatrix<double> A;
  Eigen::VectorXd inverse_sqrt_mass;
  LaplacianReport laplacian;
};

absl::StatusOr<SymmetricProblem> MakeProblem(const TriangleMesh& mesh,
                                             const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian,
                          BuildLaplacian(mesh, cancel));
  MARROW_RETURN_IF_ERROR(cancel.Check());
  SymmetricProblem problem;
  problem.laplacian = laplacian.report;
  problem.inverse_sqrt_mass = laplacian.M.cwiseSqrt().cwiseInverse();
  problem.A = problem.inverse_sqrt_mass.asDiagonal() * laplacian.L *
              problem.inverse_sqrt_mass.asDiagonal();
  return problem;
}

// Of the columns from `first` on: the entry of largest magnitude (the first,
// where several are) is positive. The constant pair, which is known exactly, is
// exact.
void Finish(Eigen::Index first, Eigen::VectorXd& values,
            EigenvectorMatrix& vectors) {
  const Eigen::Index count = vectors.cols() - first;
  using Row = Eigen::RowVectorXf;
  Row largest = Row::Zero(count);
  for (Eigen::Index v = 0; v < vectors.rows(); ++v)
    for (Eigen::Index k = 0; k < count; ++k)
      if (std::abs(vectors(v, first + k)) > std::abs(largest[k]))
        largest[k] = vectors(v, first + k);
  const Row sign =
      (largest.array() < 0).select(Row::Constant(count, -1), Row::Ones(count));
  for (Eigen::Index v = 0; v < vectors.rows(); ++v)
    vectors.row(v).tail(count) = vectors.row(v).tail(count).cwiseProduct(sign);
  if (first > 0) return;
  vectors.col(0).setOnes();
  values[0] = 0;
}

// Appends the parts, in the mesh's order and scaled, but for what is beyond
// `most` pairs, with their residuals. Empties the parts as it goes. Anything,
// once cancelled.
void Append(std::vector<SpectrumPart> parts, const std::vector<int>& order,
            const Eigen::VectorXd& scale, Eigen::Index most, double tolerance,
            Eigen::VectorXd& values, EigenvectorMatrix& vectors,
            std::vector<double>& residuals, const CancelToken& cancel) {
  const Eigen::VectorXd mass = scale.cwiseAbs2().cwiseInverse();
  Eigen::Index column = values.size(), count = column;
  for (const SpectrumPart& part : parts) count += part.end - part.first;
  count = std::min(count, most);
  values.conservativeResize(count);
  vectors.conservativeResize(scale.size(), count);
  for (SpectrumPart& part : parts) {
    const size_t stride = part.band.values.size();
    const int width = static_cast<int>(
        std::min<Eigen::Index>(part.end - part.first, count - column));
    for (int k = 0; k < width; ++k)
      values[column + k] = part.band.values[part.first + k];
    const auto first = part.band.residuals.begin() + part.first;
    residuals.insert(residuals.end(), first, first + width);
    const float* rows = part.band.vectors.data();
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      const float* row = rows + i * stride + part.first;
      const int v = order[i];
      for (int k = 0; k < width; ++k)
        vectors(v, column + k) = static_cast<float>(row[k] * scale[v]);
    }
    part.band = {};
    // What comes after is parted from the constant pair as Finish() leaves it,
    // in whatever steps it is asked for.
    if (column == 0) vectors.col(0).setOnes();
    SeparateBands(mass, residuals, kLooseShare * tolerance, column, cancel,
                  vectors);
    column += width;
  }
}

SlicingOptions OptionsFor(double tolerance) {
  SlicingOptions options;
  options.tolerance = tolerance;
  options.threads = UsualThreads();
  return options;
}

// Whether other numbers of pairs are solved for in the same way.
bool IsForAnyCount(int n, int pairs) {
  return n <= kDenseVertices || !IsSolvedDensely(n, pairs);
}

absl::StatusOr<MatrixPairs> SolveDense(const SymmetricProblem& problem,
                                       int pairs, const CancelToken& cancel) {
  MARROW_ASSIGN_OR_RETURN(MatrixPairs raw,
                          SolveDensely(problem.A, pairs, cancel));
  RemoveConstant(problem.inverse_sqrt_mass.cwiseInverse(), raw.vectors);
  return raw;
}

class SolverStream : public EigenPairStream {
 public:
  SolverStream(const CanonicalMesh& mesh, uint32_t count, double tolerance)
      : mesh_(mesh),
        most_(std::min(static_cast<int>(count) + 1,
                       static_cast<int>(mesh.mesh.NumVertices()))),
        tolerance_(tolerance) {}

  absl::StatusOr<std::shared_ptr<const EigenPairs>> UpTo(
      double bound, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    MARROW_RETURN_IF_ERROR(cancel.Check());
    if (pairs_ == nullptr || !Reaches(*pairs_, bound)) {
      MARROW_RETURN_IF_ERROR(Prepare(cancel));
      MARROW_RETURN_IF_ERROR(Extend(bound, cancel, progress));
    }
    if (progress) progress(1);
    return pairs_;
  }

 private:
  bool Reaches(const EigenPairs& pairs, double bound) const {
    const int there = static_cast<int>(pairs.NumPairs());
    return there == most_ ||
           (there > 1 && pairs.eigenvalues[there - 1] > bound);
  }

  absl::Status Prepare(const CancelToken& cancel) {
    if (prepared_) return absl::OkStatus();
    MARROW_ASSIGN_OR_RETURN(problem_, MakeProblem(mesh_.mesh, cancel));
    MARROW_RETURN_IF_ERROR(cancel.Check());
    prepared_ = true;
    if (IsSolvedDensely(static_cast<int>(problem_.A.rows()), most_))
      return absl::OkStatus();
    MARROW_ASSIGN_OR_RETURN(
        slicer_, SpectrumSlicer::Create(problem_.A, mesh_.mesh.positions.data(),
                                        most_, OptionsFor(tolerance_), cancel));
    if (problem_.A.rows() > kReferenceVertices) problem_.A = {};
    return absl::OkStatus();
  }

  absl::Status Extend(double bound, const CancelToken& cancel,
                      const ProgressCallback& progress) {
    auto pairs = std::make_shared<EigenPairs>();
    pairs->area = mesh_.report.area;
    pairs->laplacian = problem_.laplacian;
    if (pairs_ != nullptr) *pairs = *pairs_;
    const Eigen::Index before = pairs->eigenvalues.size();
    if (slicer_ == nullptr) {
      MARROW_ASSIGN_OR_RETURN(const MatrixPairs raw,
                              SolveDense(problem_, most_, cancel));
      Replace(raw, *pairs);
      pairs->for_any_count = IsForAnyCount(problem_.A.rows(), most_);
    } else {
      MARROW_RETURN_IF_ERROR(Slice(bound, cancel, progress, *pairs));
    }
    Finish(before, pairs->eigenvalues, pairs->eigenvectors);
    pairs->complete =
        pairs->eigenvalues.size() == problem_.inverse_sqrt_mass.size();
    pairs_ = std::move(pairs);
    return absl::OkStatus();
  }

  absl::Status Slice(double bound, const CancelToken& cancel,
                     const ProgressCallback& progress, EigenPairs& pairs) {
    const auto report = [&](double share) {
      if (progress) progress(kAnalysisShare + (1 - kAnalysisShare) * share);
    };
    while (!Reaches(pairs, bound)) {
      auto parts = slicer_->Find({most_, bound, 2}, cancel, report);
      if (!parts.ok()) return TakeReference(parts.status(), cancel, pairs);
      if (parts->empty()) {
        pairs.cluster_end = most_;
        break;
      }
      for (const SpectrumPart& part : *parts)
        pairs.for_any_count &= !part.of_cluster;
      Append(*std::move(parts), slicer_->order(), problem_.inverse_sqrt_mass,
             most_, tolerance_, pairs.eigenvalues, pairs.eigenvectors,
             residuals_, cancel);
      MARROW_RETURN_IF_ERROR(cancel.Check());
    }
    return absl::OkStatus();
  }

  // The way out of an error, where there is one.
  absl::Status TakeReference(const absl::Status& status,
                             const CancelToken& cancel, EigenPairs& pairs) {
    if (status.code() != absl::StatusCode::kInternal ||
        problem_.inverse_sqrt_mass.size() > kReferenceVertices)
      return status;
    MARROW_ASSIGN_OR_RETURN(
        const MatrixPairs raw,
        SolveByReference(problem_.A, most_, cancel, [](double) {}));
    Replace(raw, pairs);
    pairs.for_any_count = false;
    return absl::OkStatus();
  }

  // The pairs that are there stay.
  void Replace(const MatrixPairs& raw, EigenPairs& pairs) const {
    const Eigen::Index before = pairs.eigenvalues.size();
    const Eigen::Index more = raw.values.size() - before;
    pairs.eigenvalues.conservativeResize(before + more);
    pairs.eigenvalues.tail(more) = raw.values.tail(more);
    pairs.eigenvectors.conservativeResize(raw.vectors.rows(), before + more);
    pairs.eigenvectors.rightCols(more) =
        (problem_.inverse_sqrt_mass.asDiagonal() * raw.vectors.rightCols(more))
            .cast<float>();
  }

  const CanonicalMesh& mesh_;
  const int most_;
  const double tolerance_;
  bool prepared_ = false;
  SymmetricProblem problem_;
  std::unique_ptr<SpectrumSlicer> slicer_;
  std::shared_ptr<const EigenPairs> pairs_;
  std::vector<double> residuals_;  // of pairs_ that were sliced
};

}  // namespace

absl::StatusOr<std::shared_ptr<const EigenPairs>> SolverEigenPairSource::Get(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  return SolverStream(mesh, count, tolerance_)
      .UpTo(std::numeric_limits<double>::infinity(), cancel, progress);
}

std::unique_ptr<EigenPairStream> SolverEigenPairSource::Open(
    const CanonicalMesh& mesh, uint32_t count) {
  return std::make_unique<SolverStream>(mesh, count, tolerance_);
}

bool SolverEigenPairSource::GivesSharedPairs(const CanonicalMesh& mesh,
                                             uint32_t count) const {
  const int n = static_cast<int>(mesh.mesh.NumVertices());
  return IsForAnyCount(n, std::min(static_cast<int>(count) + 1, n));
}

double PredictSolverSeconds(uint64_t vertices, uint32_t count) {
  const double n = static_cast<double>(vertices);
  return 0.02 + n * (1e-7 * count + 5e-6);
}

uint64_t PredictSolverBytes(uint64_t vertices, uint32_t count) {
  // The pairs, once in bands and once as a whole; two threads' bases and
  // factors; the matrix.
  return vertices * (sizeof(float) * 2 * (uint64_t{count} + 1) + 4096);
}

}  // namespace marrow
