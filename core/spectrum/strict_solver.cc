// The bands of spectrum slicing are in double, and a Krylov space that has
// converged to 1e-4 needs a third more steps for 1e-8. What is left to do is
// to make the pairs of different bands orthogonal to rounding, which they are
// to about their residuals.
//
// Where bands do not get there, as where the entries of the matrix are of very
// different sizes, the usual pairs are refined by inverse iteration instead.
#include "core/spectrum/strict_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/certificate.h"
#include "core/spectrum/dense_kernels.h"
#include "core/spectrum/dense_solver.h"
#include "core/spectrum/lanczos_basis.h"
#include "core/spectrum/slicing.h"
#include "core/spectrum/solver.h"
#include "core/spectrum/team.h"

namespace marrow {
namespace {

// Bands are asked for less than is wanted in the end: to make them orthogonal
// takes a little of it.
constexpr double kBandShare = 0.75;
constexpr double kSolverShare = 0.9;
// Columns made orthogonal at a time, and rows worked on at once.
constexpr int kColumns = 48;
constexpr int kChunk = 256;
// The rows are divided into so many parts, whatever the threads.
constexpr int kSlabs = 8;

// Orthonormalises the columns of X (n x a multiple of kPad), one set of
// kColumns after the other: against those before, then among themselves. They
// are nearly orthonormal, so once is enough.
class ColumnOrthonormaliser {
 public:
  ColumnOrthonormaliser(RowMajorMatrix& X, Team& team,
                        const CancelToken& cancel)
      : X_(X), team_(team), cancel_(cancel) {}

  absl::Status Run() {
    const int columns = static_cast<int>(X_.cols());
    for (int begin = 0; begin < columns; begin += kColumns) {
      const int width = std::min(kColumns, columns - begin);
      if (begin > 0) Subtract(begin, width);
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      MakeOrthonormal(begin, width);
      MARROW_RETURN_IF_ERROR(cancel_.Check());
    }
    return absl::OkStatus();
  }

 private:
  // body(begin, rows) for every chunk of every slab, the slabs beside each
  // other.
  template <typename Body>
  void ForChunks(const Body& body) {
    const Eigen::Index n = X_.rows(), slab = (n + kSlabs - 1) / kSlabs;
    team_.For(kSlabs, [&](int s) {
      const Eigen::Index end = std::min(n, (s + 1) * slab);
      for (Eigen::Index i = s * slab; i < end; i += kChunk) {
        if (cancel_.IsCancelled()) return;
        body(s, i, static_cast<int>(std::min<Eigen::Index>(kChunk, end - i)));
      }
    });
  }

  double* At(Eigen::Index row, int column) {
    return X_.data() + row * X_.cols() + column;
  }

  // The products of columns [0, rows) and [begin, begin + width).
  RowMajorMatrix Products(int first, int count, int begin, int width) {
    const int stride = static_cast<int>(X_.cols());
    std::vector<RowMajorMatrix> parts(kSlabs,
                                      RowMajorMatrix::Zero(count, width));
    ForChunks([&](int slab, Eigen::Index i, int rows) {
      Kernels().multiply_add(count, width, rows, {At(i, first), 1, stride},
                             At(i, begin), stride, parts[slab].data(), width);
    });
    RowMajorMatrix sum = std::move(parts[0]);
    for (int s = 1; s < kSlabs; ++s) sum += parts[s];
    return sum;
  }

  void Subtract(int begin, int width) {
    const int stride = static_cast<int>(X_.cols());
    const RowMajorMatrix P = Products(0, begin, begin, width);
    ForChunks([&](int, Eigen::Index i, int rows) {
      Kernels().multiply_subtract(rows, width, begin, {At(i, 0), stride, 1},
                                  P.data(), width, At(i, begin), stride);
    });
  }

  // Columns that are zero stay so.
  void MakeOrthonormal(int begin, int width) {
    const int stride = static_cast<int>(X_.cols());
    Eigen::MatrixXd gram = Products(begin, width, begin, width);
    for (int k = 0; k < width; ++k)
      if (gram(k, k) == 0) gram(k, k) = 1;
    RowMajorMatrix B = RowMajorMatrix::Identity(width, width);
    const Eigen::LLT<Eigen::MatrixXd> cholesky(gram);
    cholesky.matrixU().solveInPlace<Eigen::OnTheRight>(B);
    ForChunks([&](int, Eigen::Index i, int rows) {
      RowMajorMatrix product = RowMajorMatrix::Zero(rows, width);
      Kernels().multiply_add(rows, width, width, {At(i, begin), stride, 1},
                             B.data(), width, product.data(), width);
      Eigen::Map<RowMajorMatrix, 0, Eigen::OuterStride<>>(
          At(i, begin), rows, width, Eigen::OuterStride<>(stride)) = product;
    });
  }

  RowMajorMatrix& X_;
  Team& team_;
  const CancelToken& cancel_;
};

class StrictSolver {
 public:
  StrictSolver(const CanonicalMesh& mesh, const Laplacian& laplacian, int total,
               const CancelToken& cancel)
      : mesh_(mesh),
        laplacian_(laplacian),
        sqrt_mass_(laplacian.M.cwiseSqrt()),
        total_(total),
        cancel_(cancel),
        team_(UsualThreads()) {}

  absl::StatusOr<CertifiedSpectrum> Solve(const ProgressCallback& progress) {
    const Eigen::VectorXd scale = sqrt_mass_.cwiseInverse();
    const Eigen::SparseMatrix<double> A =
        scale.asDiagonal() * laplacian_.L * scale.asDiagonal();
    MARROW_RETURN_IF_ERROR(cancel_.Check());
    SlicingOptions options;
    options.threads = team_.threads();
    options.tolerance = kBandShare * kStrictResidual;
    options.exact = true;
    options.max_factor_bytes = kMaxExactFactorBytes;
    MARROW_ASSIGN_OR_RETURN(
        const auto slicer,
        SpectrumSlicer::Create(A, mesh_.mesh.positions.data(), total_, options,
                               cancel_));
    MARROW_ASSIGN_OR_RETURN(std::vector<SpectrumPart> parts,
                            FindAll(*slicer, progress));
    const InertiaCount last = parts.back().counts.back();
    const Eigen::VectorXd known = ValuesOf(parts);
    spectrum_.eigenvalues = known.head(total_);
    spectrum_.eigenvalues[0] = 0;
    MARROW_RETURN_IF_ERROR(TakeVectors(std::move(parts), slicer->order()));
    MARROW_RETURN_IF_ERROR(CountPairs(
        known,
        [&](double shift) -> absl::StatusOr<InertiaCount> {
          // The slicer has been there.
          if (last.below == total_ && last.shift >= shift) return last;
          return slicer->Count(shift, cancel_);
        },
        spectrum_));
    return std::move(spectrum_);
  }

 private:
  // Find() may end early, and says why only when it is asked again.
  absl::StatusOr<std::vector<SpectrumPart>> FindAll(
      SpectrumSlicer& slicer, const ProgressCallback& progress) {
    std::vector<SpectrumPart> parts;
    double done = 0;  // each call begins its shares anew
    const auto report = [&](double share) {
      done = std::max(done, kSolverShare * share);
      progress(done);
    };
    for (int found = 0; found < total_;) {
      MARROW_ASSIGN_OR_RETURN(std::vector<SpectrumPart> more,
                              slicer.Find({.pairs = total_}, cancel_, report));
      if (more.empty()) return absl::InternalError("the bands ended early");
      for (SpectrumPart& part : more) {
        found += part.end - part.first;
        parts.push_back(std::move(part));
      }
    }
    return parts;
  }

  static Eigen::VectorXd ValuesOf(const std::vector<SpectrumPart>& parts) {
    std::vector<double> values;
    for (const SpectrumPart& part : parts)
      values.insert(values.end(), part.band.values.begin() + part.first,
                    part.band.values.begin() + part.end);
    return Eigen::Map<const Eigen::VectorXd>(
        values.data(), static_cast<Eigen::Index>(values.size()));
  }

  // The first of them, orthonormal, in the mesh's order.
  absl::Status TakeVectors(std::vector<SpectrumPart> parts,
                           const std::vector<int>& order) {
    const auto n = static_cast<Eigen::Index>(order.size());
    RowMajorMatrix X(n, PadUp(total_));
    X.rightCols(X.cols() - total_).setZero();
    int column = 0;
    for (SpectrumPart& part : parts) {
      const Eigen::Index width =
          std::min(part.end - part.first, total_ - column);
      X.middleCols(column, width) =
          Eigen::Map<const RowMajorMatrix>(part.band.exact_vectors.data(), n,
                                           part.band.values.size())
              .middleCols(part.first, width);
      column += width;
      part.band = {};
    }
    for (Eigen::Index i = 0; i < n; ++i) X(i, 0) = sqrt_mass_[order[i]];
    MARROW_RETURN_IF_ERROR(ColumnOrthonormaliser(X, team_, cancel_).Run());
    spectrum_.eigenvectors.resize(n, total_);
    spectrum_.residuals.setZero(total_);
    team_.For(PadUp(total_) / kPad, [&](int group) {
      Finish(X, order, group * kPad, std::min(total_, (group + 1) * kPad));
    });
    return cancel_.Check();
  }

  void Finish(const RowMajorMatrix& X, const std::vector<int>& order, int first,
              int end) {
    if (cancel_.IsCancelled()) return;
    auto& phi = spectrum_.eigenvectors;
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      const int v = order[i];
      for (int k = first; k < end; ++k) phi(v, k) = X(i, k) / sqrt_mass_[v];
    }
    if (first == 0) phi.col(0).setOnes();
    for (int k = first; k < end; ++k) FixSign(phi.col(k));
    MeasureResiduals(laplacian_, first, end, spectrum_);
  }

  const CanonicalMesh& mesh_;
  const Laplacian& laplacian_;
  const Eigen::VectorXd sqrt_mass_;
  const int total_;
  const CancelToken& cancel_;
  Team team_;
  CertifiedSpectrum spectrum_;
};

absl::StatusOr<CertifiedSpectrum> RefineUsualPairs(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  MARROW_ASSIGN_OR_RETURN(
      const auto pairs,
      SolverEigenPairSource(kStrictSolverTolerance)
          .Get(mesh, WithStrictGuards(count), cancel, nullptr));
  return CertifySpectrum(mesh, *pairs, count, kStrictResidual, cancel,
                         [&](double share) {
                           progress(kSolverShare + (1 - kSolverShare) * share);
                         });
}

}  // namespace

absl::StatusOr<CertifiedSpectrum> SolveStrictly(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress) {
  const ProgressCallback report = progress ? progress : [](double) {};
  const int n = static_cast<int>(mesh.mesh.NumVertices());
  const int total = static_cast<int>(std::min<int64_t>(int64_t{count} + 1, n));
  // CertifySpectrum() has a dense solver for these.
  if (IsSolvedDensely(n, total))
    return RefineUsualPairs(mesh, count, cancel, report);
  try {
    MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian,
                            BuildLaplacian(mesh.mesh, cancel));
    auto spectrum = StrictSolver(mesh, laplacian, total, cancel).Solve(report);
    if (spectrum.ok() && spectrum->residuals.maxCoeff() <= kStrictResidual) {
      spectrum->area = mesh.report.area;
      report(1);
      return spectrum;
    }
    if (!spectrum.ok() && !absl::IsInternal(spectrum.status()))
      return spectrum.status();
  } catch (const std::bad_alloc&) {
    return OutOfMemory(total, n);
  }
  return RefineUsualPairs(mesh, count, cancel, report);
}

}  // namespace marrow
