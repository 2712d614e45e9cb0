// Block Lanczos with full orthogonalisation for (A - shift I)^-1, whose largest
// eigenvalues theta = 1 / (lambda - shift) are the nearest lambda.
//
// The process begins with the solutions of a random block: it saves one block
// of a basis that would hold little of what is wanted. The projected matrix T
// is kept whole, not tridiagonal, so that a block may hold new directions where
// the process found an invariant subspace; that is how a cluster with more
// members than a block has columns comes out whole.
//
// With (A - shift I)^-1 V = V T + Q R and T s = theta s the Ritz vector V s has
// a residual under A that may be huge, for what is rough in Q. The vector
// (A - shift I)^-1 V s / theta = V s + Q R s / theta has |R s| / theta^2, free
// of it (Ericsson and Ruhe 1980). It is taken for the eigenvector.
#include "core/spectrum/band_lanczos.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"
#include "core/spectrum/lanczos_basis.h"

namespace marrow {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A gap is at least this share of the mean distance of the eigenvalues.
constexpr double kGapShare = 0.1;
// A value beyond the end is known well enough for its gap to be judged where
// its residual is at most this share of the mean distance.
constexpr double kKnownShare = 0.02;
// A pair's residual is at most this share of the mean distance, or neighbours
// are not told apart.
constexpr double kResolvedShare = 0.05;
// Looking for convergence in a basis of fewer vectors a pair is in vain.
constexpr double kFirstLook = 1.5;

// Ritz pairs on one side of the shift, the nearest first.
struct Side {
  std::vector<int> index;  // in the projected problem
  std::vector<double> value;
  std::vector<double> residual;
};

class BandFinder {
 public:
  BandFinder(const SupernodalStructure& matrix, const SupernodalFactor& factor,
             const BandRequest& request, LanczosWorkspace& workspace,
             const CancelToken& cancel)
      : matrix_(matrix),
        factor_(factor),
        request_(request),
        cancel_(cancel),
        basis_(matrix.n, workspace.blocks),
        seed_(1000 * request.extra_steps) {}

  absl::StatusOr<Band> Find(const StepCallback& on_step) {
    MARROW_RETURN_IF_ERROR(Start());
    const int wanted = request_.below + request_.above;
    const int first_look = static_cast<int>(kFirstLook * wanted);
    const int most = std::min(matrix_.n - kBlock, 6 * wanted + 20 * kBlock);
    int extra = request_.extra_steps;
    const int next_look = std::min(first_look, most - kBlock);
    while (T_.rows() + kBlock <= most) {
      MARROW_RETURN_IF_ERROR(Step());
      on_step();
      if (T_.rows() < next_look || !Converged()) continue;
      if (extra-- <= 0) return Extract();
    }
    return absl::InternalError(
        absl::StrCat("the pairs about ", factor_.shift(),
                     " did not converge in ", T_.rows(), " dimensions"));
  }

 private:
  void Fill(double* Z) {
    basis_.FillRandomly(Z, ++seed_);
    factor_.Solve(Z);
  }

  absl::Status Append(LanczosBasis::Growth& growth) {
    return basis_.Append([this](double* Z) { Fill(Z); }, cancel_, growth);
  }

  absl::Status Start() {
    Fill(basis_.Block(0));
    LanczosBasis::Growth unused;
    return Append(unused);
  }

  // Extends T by a block, and the basis by the next.
  absl::Status Step() {
    const double* last = basis_.Block(basis_.num_blocks() - 1);
    double* next = basis_.Block(basis_.num_blocks());
    std::copy_n(last, static_cast<size_t>(matrix_.n) * kBlock, next);
    MARROW_RETURN_IF_ERROR(cancel_.Check());
    factor_.Solve(next);
    LanczosBasis::Growth growth;
    MARROW_RETURN_IF_ERROR(Append(growth));
    const int old = static_cast<int>(T_.rows());
    T_.conservativeResize(old + kBlock, old + kBlock);
    T_.rightCols(kBlock) = growth.projection;
    T_.bottomRows(kBlock) = growth.projection.transpose();
    R_ = growth.remainder;
    return absl::OkStatus();
  }

  // Solves the projected problem and picks the pairs.
  bool Converged() {
    const Eigen::MatrixXd symmetric = 0.5 * (T_ + T_.transpose());
    ritz_.compute(symmetric);
    tail_ = R_ * ritz_.eigenvectors().bottomRows(kBlock);
    above_ = MakeSide(true);
    below_ = MakeSide(false);
    if (below_.value.empty() && above_.value.empty()) return false;
    floor_ = request_.all_below ? SecondLowest() : 0;
    const double distance = MeanDistance();
    num_above_ =
        request_.above == 0
            ? 0
            : Pick(above_, request_.above, request_.any_end_above, distance);
    num_below_ = Pick(below_, request_.below, request_.any_end_below, distance);
    return num_above_ >= 0 && num_below_ >= 0;
  }

  Side MakeSide(bool above) const {
    const Eigen::VectorXd& theta = ritz_.eigenvalues();
    Side side;
    const int m = static_cast<int>(theta.size());
    for (int i = 0; i < m; ++i) {
      const int k = above ? m - 1 - i : i;
      if (above ? !(theta[k] > 0) : !(theta[k] < 0)) break;
      side.index.push_back(k);
      side.value.push_back(factor_.shift() + 1 / theta[k]);
      side.residual.push_back(tail_.col(k).norm() / (theta[k] * theta[k]));
    }
    return side;
  }

  // lambda_1, where the band begins with lambda_0; the shift if in doubt.
  double SecondLowest() const {
    const size_t below = std::min<size_t>(below_.value.size(), request_.below);
    return below > 1 ? below_.value[below - 2] : factor_.shift();
  }

  double MeanDistance() const {
    const int above = std::min<int>(above_.value.size(), request_.above);
    const int below = std::min<int>(below_.value.size(), request_.below);
    const double high = above > 0 ? above_.value[above - 1] : factor_.shift();
    const double low = below > 0 ? below_.value[below - 1] : factor_.shift();
    return (high - low) / std::max(1, above + below);
  }

  bool IsConverged(const Side& side, int i, double distance) const {
    return side.residual[i] <=
           std::min(request_.tolerance * std::max(side.value[i], floor_),
                    kResolvedShare * distance);
  }

  // How many pairs of the side to take: at least `wanted`, then up to a gap
  // unless any end will do. -1 where they have not converged.
  int Pick(const Side& side, int wanted, bool any_end, double distance) const {
    const int size = static_cast<int>(side.value.size());
    for (int count = 0; count <= size; ++count) {
      if (count > 0 && !IsConverged(side, count - 1, distance)) return -1;
      if (count < wanted) continue;
      if (any_end) return count;
      if (count == size) return -1;
      const double known = side.residual[count];
      const double from = count > 0 ? side.value[count - 1] : factor_.shift();
      const double gap = std::abs(side.value[count] - from) - known;
      if (known > kKnownShare * distance && gap < distance) return -1;
      if (gap >= kGapShare * distance) return count;
    }
    return -1;
  }

  absl::StatusOr<Band> Extract() {
    Band band;
    band.below = num_below_;
    std::vector<int> chosen;
    for (int i = num_below_; i-- > 0;) {
      chosen.push_back(below_.index[i]);
      band.values.push_back(below_.value[i]);
    }
    for (int i = 0; i < num_above_; ++i) {
      chosen.push_back(above_.index[i]);
      band.values.push_back(above_.value[i]);
    }
    band.next_above = NextAbove();
    band.next_below = request_.any_end_below || !HasNext(below_, num_below_)
                          ? -kInfinity
                          : below_.value[num_below_];
    MARROW_RETURN_IF_ERROR(WriteVectors(Coefficients(chosen), band));
    return band;
  }

  double NextAbove() const {
    if (request_.above == 0) return factor_.shift();
    if (request_.any_end_above || !HasNext(above_, num_above_))
      return kInfinity;
    return above_.value[num_above_];
  }

  static bool HasNext(const Side& side, int count) {
    return count < static_cast<int>(side.value.size());
  }

  // Of the vectors in the basis, the last block included; orthonormalised,
  // which is a matter of their tails alone.
  RowMajorMatrix Coefficients(const std::vector<int>& chosen) const {
    const int m = static_cast<int>(T_.rows());
    const int count = static_cast<int>(chosen.size());
    Eigen::MatrixXd coefficients(m + kBlock, count);
    for (int c = 0; c < count; ++c) {
      const double theta = ritz_.eigenvalues()[chosen[c]];
      coefficients.col(c) << ritz_.eigenvectors().col(chosen[c]),
          tail_.col(chosen[c]) / theta;
    }
    const Eigen::MatrixXd gram = coefficients.transpose() * coefficients;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(gram);
    return cholesky.matrixU().solve<Eigen::OnTheRight>(coefficients);
  }

  absl::Status WriteVectors(const RowMajorMatrix& coefficients, Band& band) {
    const int count = static_cast<int>(band.values.size());
    const size_t n = matrix_.n;
    band.vectors.resize(n * count);
    double* Y = basis_.Block(basis_.num_blocks());
    double* AY = basis_.Block(basis_.num_blocks() + 1);
    for (int begin = 0; begin < count; begin += kBlock) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const int width = std::min(kBlock, count - begin);
      RowMajorMatrix block =
          RowMajorMatrix::Zero(coefficients.rows(), kBlock);
      block.leftCols(width) = coefficients.middleCols(begin, width);
      basis_.Combine(block, Y);
      for (size_t i = 0; i < n; ++i)
        for (int c = 0; c < width; ++c)
          band.vectors[i * count + begin + c] =
              static_cast<float>(Y[i * kBlock + c]);
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      matrix_.Multiply(Y, AY);
      MeasureResiduals(Y, AY, begin, width, band);
    }
    if (band.residual <= kResidualSlack * request_.tolerance)
      return absl::OkStatus();
    return absl::InternalError(absl::StrCat("a pair about ", factor_.shift(),
                                            " has the residual ",
                                            band.residual));
  }

  void MeasureResiduals(const double* Y, const double* AY, int begin, int width,
                        Band& band) const {
    std::vector<double> sums(kBlock, 0.0);
    for (int i = 0; i < matrix_.n; ++i)
      for (int c = 0; c < width; ++c) {
        const size_t at = static_cast<size_t>(i) * kBlock + c;
        const double r = AY[at] - band.values[begin + c] * Y[at];
        sums[c] += r * r;
      }
    for (int c = 0; c < width; ++c)
      band.residual =
          std::max(band.residual, std::sqrt(sums[c]) /
                                      std::max(band.values[begin + c], floor_));
  }

  // The estimate leaves out rounding and the other pairs' share.
  static constexpr double kResidualSlack = 10;

  const SupernodalStructure& matrix_;
  const SupernodalFactor& factor_;
  const BandRequest& request_;
  const CancelToken& cancel_;
  LanczosBasis basis_;
  uint64_t seed_;
  Eigen::MatrixXd T_;
  Eigen::MatrixXd R_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz_;
  Eigen::MatrixXd tail_;  // R times the last block of every Ritz vector
  Side above_, below_;
  double floor_ = 0;
  int num_above_ = 0, num_below_ = 0;
};

}  // namespace

absl::StatusOr<Band> FindBand(const SupernodalStructure& matrix,
                              const SupernodalFactor& factor,
                              const BandRequest& request,
                              LanczosWorkspace& workspace,
                              const CancelToken& cancel,
                              const StepCallback& on_step) {
  return BandFinder(matrix, factor, request, workspace, cancel).Find(on_step);
}

}  // namespace marrow
