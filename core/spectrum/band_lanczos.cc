// Block Lanczos for (A - shift I)^-1, whose largest eigenvalues
// theta = 1 / (lambda - shift) are the nearest lambda.
//
// With (A - shift I)^-1 V = V T + Q R and T s = theta s the Ritz vector V s has
// a residual under A that may be huge, for what is rough in Q. The vector
// (A - shift I)^-1 V s / theta = V s + Q R s / theta has |R s| / theta^2, free
// of it (Ericsson and Ruhe 1980). It is taken for the eigenvector.
//
// Starting from a coarse problem's vectors was tried and was slower: a Krylov
// space is better at parting neighbours than at being told about them.
#include "core/spectrum/band_lanczos.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"
#include "core/spectrum/dense_solver.h"
#include "core/spectrum/inverse_iteration.h"
#include "core/spectrum/lanczos_basis.h"
#include "core/spectrum/lanczos_process.h"

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
constexpr double kFirstLook = 2;
// Residuals fall by less than so many decades a step, or as fast as they last
// did; a look costs as much as a step, so steps that cannot be the last go
// unseen.
constexpr double kUsualRate = 1;
constexpr double kTrustedShare = 0.8;
// A basis of more than so many vectors a pair, or in all, grows by this share
// between looks, whose cost is cubic: many equal eigenvalues take a basis that
// large.
constexpr int kSlow = 5;
constexpr int kSlowBasis = 320;
constexpr int kSlowLooks = 4;
// From here on a look takes so long that more must come of it.
constexpr int kLargeBasis = 560;
constexpr double kMostExcess = 6;
// Blocks written at once, so that the basis is read once for them; fewer where
// they are large.
constexpr int kMostTogether = 7;
constexpr int kLeastTogether = 3;
constexpr int kLargeBlocks = 300'000;
// The estimate of a residual leaves out rounding and the other pairs' share.
constexpr double kEstimateShare = 0.5;
constexpr int kMostRefinements = 4;
// Of the distance of the last pair that is refined.
constexpr double kRefinedReach = 2;

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
             Team& team, const CancelToken& cancel)
      : matrix_(matrix),
        factor_(factor),
        request_(request),
        team_(team),
        cancel_(cancel),
        process_(matrix.n, factor, uint64_t{1000} * request.extra_steps,
                 workspace.blocks, team, cancel) {}

  absl::StatusOr<Band> Find(const StepCallback& on_step) {
    MARROW_RETURN_IF_ERROR(process_.Start());
    const int wanted = request_.below + request_.above;
    const int most = std::min(matrix_.n - kBlock, 6 * wanted + 40 * kBlock);
    const int first_look =
        std::min(static_cast<int>(kFirstLook * wanted), most - kBlock);
    int unseen = 0, enough = -1;  // blocks
    while (basis_.dimension() < most) {
      MARROW_RETURN_IF_ERROR(process_.Step());
      on_step();
      if (process_.T().rows() < first_look) continue;
      if (unseen-- > 0 && basis_.dimension() < most) continue;
      MARROW_RETURN_IF_ERROR(Look(kBlock));
      if (Converged()) {
        if (enough < 0) enough = basis_.num_blocks() + request_.extra_steps;
        if (basis_.num_blocks() >= enough || basis_.dimension() >= most)
          return Extract();
        unseen = enough - basis_.num_blocks() - 1;
      } else if (Stagnates()) {
        break;
      } else {
        unseen = StepsToGo();
      }
    }
    return absl::InternalError(absl::StrCat("the pairs about ", factor_.shift(),
                                            " did not converge in ",
                                            basis_.dimension(), " dimensions"));
  }

 private:
  // Solves the projected problem, for so many of the last rows of its vectors.
  absl::Status Look(Eigen::Index rows) {
    const Eigen::MatrixXd& T = process_.T();
    MARROW_ASSIGN_OR_RETURN(
        ritz_, SolveForLastRows(0.5 * (T + T.transpose()), rows, cancel_));
    tail_ = process_.R() * ritz_.vectors.bottomRows(kBlock);
    return absl::OkStatus();
  }

  // Picks the pairs.
  bool Converged() {
    above_ = MakeSide(true);
    below_ = MakeSide(false);
    if (below_.value.empty() && above_.value.empty()) return false;
    floor_ = request_.all_below ? SecondLowest() : 0;
    distance_ = MeanDistance();
    num_above_ = request_.above == 0 ? 0
                                     : Pick(above_, request_.above,
                                            request_.any_end_above, distance_);
    num_below_ =
        Pick(below_, request_.below, request_.any_end_below, distance_);
    return num_above_ >= 0 && num_below_ >= 0;
  }

  // Whether a basis that is large already has no more converged pairs than at
  // the look before. So it is where very many eigenvalues are equal: a block
  // has few directions of their space, and later blocks hardly any new ones.
  bool Stagnates() {
    const int before =
        std::exchange(converged_, NumConverged(above_) + NumConverged(below_));
    return basis_.dimension() > kLargeBasis && converged_ <= before;
  }

  int NumConverged(const Side& side) const {
    int count = 0;
    while (HasNext(side, count) &&
           side.residual[count] <= Allowed(side, count, distance_))
      ++count;
    return count;
  }

  // How many steps from here on are not worth a look.
  int StepsToGo() {
    const double excess = std::max(Excess(above_, request_.above),
                                   Excess(below_, request_.below));
    const int steps = basis_.num_blocks() - last_look_;
    const double rate = std::max(kUsualRate, (last_excess_ - excess) / steps);
    last_look_ = basis_.num_blocks();
    last_excess_ = excess;
    const int guess = static_cast<int>(kTrustedShare * excess / rate);
    const int wanted = request_.below + request_.above;
    const bool slow = basis_.dimension() > std::min(kSlow * wanted, kSlowBasis);
    return slow ? std::max(guess, last_look_ / kSlowLooks) : guess;
  }

  // By how many decades a residual is too large.
  double Excess(const Side& side, int wanted) const {
    double excess = 0;
    const int there = std::min(wanted, static_cast<int>(side.value.size()));
    for (int i = 0; i < there; ++i)
      excess = std::max(
          excess, std::log10(side.residual[i] / Allowed(side, i, distance_)));
    return std::min(excess, kMostExcess);
  }

  Side MakeSide(bool above) const {
    const Eigen::VectorXd& theta = ritz_.values;
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

  double Allowed(const Side& side, int i, double distance) const {
    const double size = std::max(side.value[i], floor_);
    return std::min(kEstimateShare * request_.tolerance * size,
                    kResolvedShare * distance);
  }

  // How many pairs of the side to take: at least `wanted`, then up to a gap
  // unless any end will do. -1 where they have not converged.
  int Pick(const Side& side, int wanted, bool any_end, double distance) const {
    const int size = static_cast<int>(side.value.size());
    for (int count = 0; count <= size; ++count) {
      if (count > 0 &&
          !(side.residual[count - 1] <= Allowed(side, count - 1, distance)))
        return -1;
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
    // By the same steps, so the values are those that were looked at.
    MARROW_RETURN_IF_ERROR(Look(process_.T().rows()));
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
    if (Worst(band) > request_.tolerance) MARROW_RETURN_IF_ERROR(Refine(band));
    if (const double worst = Worst(band); !(worst <= request_.tolerance))
      return absl::InternalError(absl::StrCat("a pair about ", factor_.shift(),
                                              " has the residual ", worst));
    return band;
  }

  static double Worst(const Band& band) {
    return *std::max_element(band.residuals.begin(), band.residuals.end());
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
    const int count = static_cast<int>(chosen.size());
    Eigen::MatrixXd coefficients(basis_.dimension(), count);
    for (int c = 0; c < count; ++c) {
      const double theta = ritz_.values[chosen[c]];
      coefficients.col(c) << ritz_.vectors.col(chosen[c]),
          tail_.col(chosen[c]) / theta;
    }
    const Eigen::MatrixXd gram = coefficients.transpose() * coefficients;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(gram);
    return cholesky.matrixU().solve<Eigen::OnTheRight>(coefficients);
  }

  absl::Status WriteVectors(const RowMajorMatrix& coefficients, Band& band) {
    const size_t count = band.values.size();
    if (request_.exact) {
      band.exact_vectors.resize(matrix_.n * count);
    } else {
      band.vectors.resize(matrix_.n * count);
    }
    band.residuals.resize(count);
    const size_t most =
        size_t{kBlock} *
        (matrix_.n < kLargeBlocks ? kMostTogether : kLeastTogether);
    size_t there;
    for (size_t begin = 0; begin < count; begin += there) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      there = std::min(most, count - begin);
      RowMajorMatrix some = RowMajorMatrix::Zero(
          coefficients.rows(), Window::PaddedWidth(static_cast<int>(there)));
      some.leftCols(there) = coefficients.middleCols(begin, there);
      MARROW_RETURN_IF_ERROR(WriteBlocks(some, begin, band));
    }
    return absl::OkStatus();
  }

  // Inverse iteration takes away what rounding left of the residuals, which is
  // much where the entries of the matrix are of very different sizes, and most
  // beside the shift. Beyond the pairs that need it others are iterated: what
  // is left of those in them would grow, or shrink too slowly.
  absl::Status Refine(Band& band) {
    const double reach = kRefinedReach * FarthestWanting(band);
    const int low = CountWithin(below_, reach);
    std::vector<int> chosen(below_.index.rend() - low, below_.index.rend());
    chosen.insert(chosen.end(), above_.index.begin(),
                  above_.index.begin() + CountWithin(above_, reach));
    MARROW_ASSIGN_OR_RETURN(Window window, MakeWindow(chosen));
    for (int i = 0; i < kMostRefinements && Worst(band) > request_.tolerance;
         ++i) {
      MARROW_RETURN_IF_ERROR(IterateInversely(factor_, window, cancel_));
      MARROW_RETURN_IF_ERROR(TakeVectors(window, num_below_ - low, band));
    }
    return absl::OkStatus();
  }

  // How far from the shift the last pair is whose residual is too large.
  double FarthestWanting(const Band& band) const {
    double distance = 0;
    for (size_t k = 0; k < band.values.size(); ++k)
      if (!(band.residuals[k] <= request_.tolerance))
        distance =
            std::max(distance, std::abs(band.values[k] - factor_.shift()));
    return distance;
  }

  int CountWithin(const Side& side, double reach) const {
    int count = 0;
    while (HasNext(side, count) &&
           std::abs(side.value[count] - factor_.shift()) <= reach)
      ++count;
    return count;
  }

  absl::StatusOr<Window> MakeWindow(const std::vector<int>& chosen) {
    const int count = static_cast<int>(chosen.size());
    const RowMajorMatrix coefficients = Coefficients(chosen);
    Window window;
    window.values = Eigen::VectorXd::Zero(count);
    window.vectors =
        RowMajorMatrix::Zero(matrix_.n, Window::PaddedWidth(count));
    RowMajorMatrix block = RowMajorMatrix::Zero(coefficients.rows(), kBlock);
    for (int begin = 0; begin < count; begin += kBlock) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const int width = std::min(kBlock, count - begin);
      block.setZero();
      block.leftCols(width) = coefficients.middleCols(begin, width);
      double* Y = basis_.Block(basis_.num_blocks());
      MARROW_RETURN_IF_ERROR(basis_.Combine(block, {&Y, 1}, cancel_));
      window.vectors.middleCols(begin, kBlock) =
          Eigen::Map<const RowMajorMatrix>(Y, matrix_.n, kBlock);
    }
    return window;
  }

  // Those that the band has of a window, whose first would be its pair `first`.
  absl::Status TakeVectors(const Window& window, int first, Band& band) {
    const int begin = std::max(0, first);
    const int end = std::min(static_cast<int>(band.values.size()),
                             first + static_cast<int>(window.values.size()));
    for (int k = begin; k < end; ++k) band.values[k] = window.values[k - first];
    double* Y = basis_.Block(basis_.num_blocks());
    double* scratch = basis_.Block(basis_.num_blocks() + 1);
    Eigen::Map<RowMajorMatrix> block(Y, matrix_.n, kBlock);
    for (int k = begin; k < end; k += kBlock) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      const int width = std::min(kBlock, end - k);
      block.leftCols(width) = window.vectors.middleCols(k - first, width);
      WriteBlock(k, width, Y, scratch, band);
    }
    return absl::OkStatus();
  }

  // Vectors `begin` and after of the band, and their residuals.
  absl::Status WriteBlocks(const RowMajorMatrix& coefficients, size_t begin,
                           Band& band) {
    const int blocks = static_cast<int>(coefficients.cols()) / kBlock;
    const int scratch_blocks = std::min(blocks, team_.threads());
    std::vector<double*> Y, scratch;
    for (int i = 0; i < blocks; ++i)
      Y.push_back(basis_.Block(basis_.num_blocks() + i));
    for (int i = 0; i < scratch_blocks; ++i)
      scratch.push_back(basis_.Block(basis_.num_blocks() + blocks + i));
    MARROW_RETURN_IF_ERROR(basis_.Combine(coefficients, Y, cancel_));
    for (int b = 0; b < blocks; b += scratch_blocks) {
      MARROW_RETURN_IF_ERROR(cancel_.Check());
      team_.For(std::min(scratch_blocks, blocks - b), [&](int i) {
        const size_t first = begin + static_cast<size_t>(b + i) * kBlock;
        const size_t count = band.values.size();
        if (first < count)
          WriteBlock(first, std::min<size_t>(kBlock, count - first), Y[b + i],
                     scratch[i], band);
      });
    }
    return absl::OkStatus();
  }

  void WriteBlock(size_t begin, size_t width, const double* Y, double* residual,
                  Band& band) const {
    const size_t count = band.values.size();
    std::array<double, kBlock> lambda{}, sums{};
    std::copy_n(band.values.begin() + begin, width, lambda.begin());
    for (int i = 0; i < matrix_.n; ++i) {
      const double* row = Y + static_cast<size_t>(i) * kBlock;
      if (request_.exact) {
        std::copy_n(row, width, &band.exact_vectors[i * count + begin]);
      } else {
        std::copy_n(row, width, &band.vectors[i * count + begin]);
      }
      for (int c = 0; c < kBlock; ++c)
        residual[static_cast<size_t>(i) * kBlock + c] = lambda[c] * row[c];
    }
    matrix_.SubtractProduct(Y, residual);
    for (size_t i = 0; i < static_cast<size_t>(matrix_.n); ++i)
      for (int c = 0; c < kBlock; ++c)
        sums[c] += residual[i * kBlock + c] * residual[i * kBlock + c];
    for (size_t c = 0; c < width; ++c)
      band.residuals[begin + c] =
          std::sqrt(sums[c]) / std::max(lambda[c], floor_);
  }

  const SupernodalStructure& matrix_;
  const SupernodalFactor& factor_;
  const BandRequest& request_;
  Team& team_;
  const CancelToken& cancel_;
  LanczosProcess process_;
  LanczosBasis& basis_ = process_.basis();
  MatrixPairs ritz_;
  Eigen::MatrixXd tail_;  // R times the last block of every Ritz vector
  Side above_, below_;
  double floor_ = 0;
  double distance_ = 0;  // the mean one of the eigenvalues
  int last_look_ = 0;    // blocks there were
  double last_excess_ = 0;
  int converged_ = 0;  // pairs, at the last look
  int num_above_ = 0, num_below_ = 0;
};

}  // namespace

absl::StatusOr<Band> FindBand(const SupernodalStructure& matrix,
                              const SupernodalFactor& factor,
                              const BandRequest& request,
                              LanczosWorkspace& workspace, Team& team,
                              const CancelToken& cancel,
                              const StepCallback& on_step) {
  return BandFinder(matrix, factor, request, workspace, team, cancel)
      .Find(on_step);
}

}  // namespace marrow
