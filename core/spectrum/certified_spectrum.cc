// The pairs are taken in windows of neighbours, each about a shift of its own,
// with some of those beyond either end to keep the ends clean. Every shift
// counts the eigenvalues below it, so a pair that is missing or there twice is
// noticed at the first shift above it.
#include "core/spectrum/certified_spectrum.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/certificate.h"
#include "core/spectrum/dense_solver.h"
#include "core/spectrum/inverse_iteration.h"
#include "core/spectrum/shift_grid.h"

namespace marrow {
namespace {

// Pairs of a window. Those at the low end have small ones, as what is left of
// an iteration is in units of the distance to the shift, and a residual in
// units of the eigenvalue.
constexpr int kLeastOwn = 8;
constexpr int kMostOwn = 48;
// Pairs beyond its ends: all whose distance to the shift is less than this
// many times that of an own pair, but at most so many.
constexpr double kReach = 2;
constexpr int kMostGuards = 48;
constexpr int kMostIterations = 6;
// An iteration that does not bring the residual below this share was the last.
constexpr double kWorthwhile = 0.8;
constexpr double kAnalysisShare = 0.1;
// How far the products of vectors may be from 0 and 1: this, or this share of
// the residual asked for.
constexpr double kOrthonormal = 1e-8;
constexpr double kOrthonormalShare = 0.01;

class Certifier {
 public:
  Certifier(const EigenPairs& pairs, const Laplacian& laplacian,
            const SupernodalStructure& structure, int count, double residual,
            const CancelToken& cancel)
      : pairs_(pairs),
        count_(count),
        laplacian_(laplacian),
        structure_(structure),
        sqrt_mass_(laplacian.M.cwiseSqrt()),
        residual_(residual),
        cancel_(cancel) {
    spectrum_.eigenvalues = pairs.eigenvalues.head(count);
    spectrum_.eigenvectors.resize(structure.n, count);
    spectrum_.eigenvectors.col(0).setOnes();
    spectrum_.residuals.setZero(count);
  }

  absl::StatusOr<CertifiedSpectrum> Certify(const ProgressCallback& progress) {
    for (int first = 1, end; first < count_; first = end) {
      end = EndOfWindow(first);
      windows_.push_back({first, end});
    }
    MARROW_RETURN_IF_ERROR(RefineAll(progress));
    MARROW_RETURN_IF_ERROR(OrthogonaliseWindows());
    MARROW_RETURN_IF_ERROR(CheckOrthonormal());
    MARROW_RETURN_IF_ERROR(Count());
    return std::move(spectrum_);
  }

 private:
  double Gap(int pair) const {
    return pairs_.eigenvalues[pair] - pairs_.eigenvalues[pair - 1];
  }
  double MiddleOfGap(int pair) const {
    return 0.5 * (pairs_.eigenvalues[pair] + pairs_.eigenvalues[pair - 1]);
  }

  // The pair of [first, end) with the largest gap below it, of large ones one
  // whose gap is near `middle`.
  int BestGap(int first, int end, double middle) const {
    const double width =
        pairs_.eigenvalues[end - 1] - pairs_.eigenvalues[first - 1];
    const auto worth = [&](int pair) {
      return Gap(pair) / (width + 4 * std::abs(MiddleOfGap(pair) - middle));
    };
    int best = first;
    for (int pair = first + 1; pair < end; ++pair)
      if (worth(pair) > worth(best)) best = pair;
    return best;
  }

  int EndOfWindow(int first) const {
    const int own = std::clamp(first, kLeastOwn, kMostOwn);
    if (count_ - first <= own + own / 2) return count_;
    return BestGap(first + own - own / 4, first + own + own / 4,
                   pairs_.eigenvalues[first + own]);
  }

  // Factorises in the gap below `pair`.
  absl::Status FactoriseBelow(int pair, SupernodalFactor& factor) {
    Team alone(1);
    MARROW_RETURN_IF_ERROR(
        FactoriseNear(MiddleOfGap(pair), factor, alone, cancel_));
    const int counted = factor.negative_pivots();
    if (counted != pair && Gap(pair) > kCountableGap * factor.shift())
      return Disagreement(factor.shift(), counted, pair);
    return absl::OkStatus();
  }

  // Two threads, where two factors are no matter, take every other window each.
  absl::Status RefineAll(const ProgressCallback& progress) {
    const int workers = structure_.branches.empty() ? 2 : 1;
    std::atomic<int> done{0};
    std::vector<absl::Status> status(workers);
    std::vector<std::thread> others;
    for (int w = 1; w < workers; ++w)
      others.emplace_back(
          [&, w] { status[w] = RefineSome(w, workers, [&] { ++done; }); });
    status[0] = RefineSome(0, workers, [&] {
      progress(kAnalysisShare + (1 - kAnalysisShare) * ++done /
                                    static_cast<double>(windows_.size()));
    });
    for (std::thread& other : others) other.join();
    for (const absl::Status& each : status) MARROW_RETURN_IF_ERROR(each);
    return absl::OkStatus();
  }

  absl::Status RefineSome(int worker, int workers,
                          const std::function<void()>& on_window) {
    try {
      SupernodalFactor factor(structure_);
      for (size_t i = worker; i < windows_.size(); i += workers) {
        MARROW_RETURN_IF_ERROR(
            Refine(windows_[i].first, windows_[i].end, factor));
        on_window();
      }
    } catch (const std::bad_alloc&) {
      return OutOfMemory(count_, structure_.n);
    }
    return absl::OkStatus();
  }

  absl::Status Refine(int first, int end, SupernodalFactor& factor) {
    const Eigen::VectorXd& values = pairs_.eigenvalues;
    const double middle = 0.5 * (values[first] + values[end - 1]);
    MARROW_RETURN_IF_ERROR(FactoriseBelow(BestGap(first, end, middle), factor));
    const double reach = kReach * std::max(values[end - 1] - factor.shift(),
                                           factor.shift() - values[first]);
    int low = first, high = end;
    while (low > 0 && first - low < kMostGuards &&
           values[low] > factor.shift() - reach)
      --low;
    while (high < values.size() && high - end < kMostGuards &&
           values[high - 1] < factor.shift() + reach)
      ++high;
    Window window = MakeWindow(low, high);
    double last = 1;
    for (int i = 0; i < kMostIterations; ++i) {
      MARROW_RETURN_IF_ERROR(IterateInversely(factor, window, cancel_));
      Take(window, low, first, end);
      const double worst = MeasureResiduals(laplacian_, first, end, spectrum_);
      if (worst <= residual_ || worst > kWorthwhile * last) break;
      last = worst;
    }
    return absl::OkStatus();
  }

  Window MakeWindow(int low, int high) const {
    Window window;
    const int width = high - low;
    window.values = pairs_.eigenvalues.segment(low, width);
    window.vectors =
        RowMajorMatrix::Zero(structure_.n, Window::PaddedWidth(width));
    for (int i = 0; i < structure_.n; ++i) {
      const int v = structure_.order[i];
      const float* row = pairs_.eigenvectors.row(v).data() + low;
      double* out = window.vectors.row(i).data();
      for (int k = 0; k < width; ++k) out[k] = sqrt_mass_[v] * row[k];
    }
    return window;
  }

  // The pairs [first, end) of a window that begins with pair `low`, orthogonal
  // to the constant one.
  void Take(const Window& window, int low, int first, int end) {
    for (int k = first; k < end; ++k) {
      auto phi = spectrum_.eigenvectors.col(k);
      for (int i = 0; i < structure_.n; ++i) {
        const int v = structure_.order[i];
        phi[v] = window.vectors(i, k - low) / sqrt_mass_[v];
      }
      phi.array() -= laplacian_.M.dot(phi);
      spectrum_.eigenvalues[k] = window.values[k - low];
    }
  }

  // Windows are orthogonal to each other as far as their residuals go over the
  // gap between them. Each is freed of those below it.
  absl::Status OrthogonaliseWindows() {
    auto& phi = spectrum_.eigenvectors;
    for (const auto& [first, end] : windows_) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      if (first > 1) {
        const auto below = phi.leftCols(first);
        auto own = phi.middleCols(first, end - first);
        const Eigen::MatrixXd products =
            below.transpose() * (laplacian_.M.asDiagonal() * own);
        own.noalias() -= below * products;
      }
      for (int k = first; k < end; ++k) FixSign(phi.col(k));
      MeasureResiduals(laplacian_, first, end, spectrum_);
    }
    MeasureResiduals(laplacian_, 0, 1, spectrum_);
    return absl::OkStatus();
  }

  // Windows that part a cluster may find one vector of it twice.
  absl::Status CheckOrthonormal() {
    const double most = std::max(kOrthonormal, kOrthonormalShare * residual_);
    const Eigen::MatrixXd& phi = spectrum_.eigenvectors;
    for (const auto& [first, end] : windows_) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const Eigen::Index width = end - first;
      Eigen::MatrixXd products =
          phi.leftCols(end).transpose() *
          (laplacian_.M.asDiagonal() * phi.middleCols(first, width));
      products.bottomRows(width) -= Eigen::MatrixXd::Identity(width, width);
      if (!(products.cwiseAbs().maxCoeff() <= most))
        return WithReason(
            absl::InternalError("so many eigenvalues are equal that their "
                                "vectors cannot be told apart; ask for "
                                "fewer pairs"),
            kReasonSolverNotConverged);
    }
    return absl::OkStatus();
  }

  absl::Status Count() {
    SupernodalFactor factor(structure_);
    Team alone(1);
    return CountPairs(
        pairs_.eigenvalues,
        [&](double shift) -> absl::StatusOr<InertiaCount> {
          MARROW_RETURN_IF_ERROR(FactoriseNear(shift, factor, alone, cancel_));
          return InertiaCount{factor.shift(), factor.negative_pivots()};
        },
        spectrum_);
  }

  struct WindowRange {
    int first;
    int end;
  };

  const EigenPairs& pairs_;
  const int count_;
  const Laplacian& laplacian_;
  const SupernodalStructure& structure_;
  const Eigen::VectorXd sqrt_mass_;
  const double residual_;
  const CancelToken& cancel_;
  std::vector<WindowRange> windows_;
  CertifiedSpectrum spectrum_;
};

// A dense solver has them all, so a bound is where the last one wanted ends.
absl::StatusOr<CertifiedSpectrum> CertifyDensely(
    const Eigen::SparseMatrix<double>& A, const Laplacian& laplacian, int count,
    const CancelToken& cancel) {
  const int n = static_cast<int>(A.rows());
  MARROW_ASSIGN_OR_RETURN(MatrixPairs all, SolveDensely(A, n, cancel));
  RemoveConstant(laplacian.M.cwiseSqrt(), all.vectors);
  CertifiedSpectrum spectrum;
  spectrum.eigenvalues = all.values.head(count);
  spectrum.eigenvalues[0] = 0;
  spectrum.eigenvectors = laplacian.M.cwiseSqrt().cwiseInverse().asDiagonal() *
                          all.vectors.leftCols(count);
  spectrum.eigenvectors.col(0).setOnes();
  for (int k = 1; k < count; ++k) FixSign(spectrum.eigenvectors.col(k));
  spectrum.residuals.resize(count);
  MeasureResiduals(laplacian, 0, count, spectrum);
  int bounded = count;
  const auto gap = [&](int pair) {
    return all.values[pair] - all.values[pair - 1];
  };
  while (bounded > 1 && bounded < n &&
         gap(bounded) <= kCountableGap * all.values[bounded])
    --bounded;
  spectrum.bound = bounded == n
                       ? all.values[n - 1] * (1 + kCountableGap)
                       : 0.5 * (all.values[bounded - 1] + all.values[bounded]);
  spectrum.count_below_bound = bounded;
  return spectrum;
}

absl::StatusOr<CertifiedSpectrum> CertifySparsely(
    const CanonicalMesh& mesh, const EigenPairs& pairs,
    const Eigen::SparseMatrix<double>& A, const Laplacian& laplacian, int count,
    double residual, const CancelToken& cancel,
    const ProgressCallback& progress) {
  MARROW_ASSIGN_OR_RETURN(const SupernodalStructure structure,
                          AnalyseStructure(A, mesh.mesh.positions.data(),
                                           kMaxExactFactorBytes, 1, cancel));
  progress(kAnalysisShare);
  return Certifier(pairs, laplacian, structure, count, residual, cancel)
      .Certify(progress);
}

}  // namespace

uint32_t WithStrictGuards(uint32_t count) {
  return count + std::clamp<uint32_t>(count / 4, 16, kMostGuards);
}

absl::StatusOr<CertifiedSpectrum> CertifySpectrum(
    const CanonicalMesh& mesh, const EigenPairs& pairs, uint32_t wanted,
    double residual, const CancelToken& cancel,
    const ProgressCallback& progress) {
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian,
                          BuildLaplacian(mesh.mesh, cancel));
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> A =
      scale.asDiagonal() * laplacian.L * scale.asDiagonal();
  const int n = static_cast<int>(A.rows());
  const int count = static_cast<int>(std::min(pairs.NumPairs(), wanted + 1));
  const ProgressCallback report = progress ? progress : [](double) {};
  try {
    absl::StatusOr<CertifiedSpectrum> spectrum =
        IsSolvedDensely(n, count)
            ? CertifyDensely(A, laplacian, count, cancel)
            : CertifySparsely(mesh, pairs, A, laplacian, count, residual,
                              cancel, report);
    if (!spectrum.ok()) return spectrum.status();
    spectrum->area = pairs.area;
    spectrum->complete = count == n;
    report(1);
    return spectrum;
  } catch (const std::bad_alloc&) {
    return OutOfMemory(count, n);
  }
}

}  // namespace marrow
