#include "core/boundaries/multigrid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace marrow {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

// Up to this size the coarsest level is solved directly; beyond it, where a
// mesh does not become coarser, it is only smoothed.
constexpr Eigen::Index kDirect = 300;
constexpr double kLeastCoarsening = 0.7;
constexpr int kMaxSteps = 500;
// Entries of L below this share of the geometric mean of their diagonal entries
// couple nothing; so no row has more than 400 that do, and a hub with a million
// neighbours stays alone.
constexpr double kStrong = 0.05;
// Weight of the neighbours in the smoothing of what is interpolated: 4/3 over
// the greatest eigenvalue of D^-1 L, which is at most 2.
constexpr double kSmoothing = 2.0 / 3;

// What couples nodes, as positive weights: L without its weak entries and its
// diagonal.
Matrix Couplings(const Matrix& L) {
  const Eigen::VectorXd diagonal = L.diagonal();
  Matrix coupled(L.rows(), L.cols());
  coupled.reserve(L.nonZeros());
  for (Eigen::Index j = 0; j < L.outerSize(); ++j) {
    coupled.startVec(j);
    for (Matrix::InnerIterator entry(L, j); entry; ++entry) {
      const double weak =
          kStrong * std::sqrt(diagonal[entry.row()] * diagonal[j]);
      if (entry.row() != j && -entry.value() > weak)
        coupled.insertBack(entry.row(), j) = -entry.value();
    }
  }
  coupled.finalize();
  return coupled;
}

// Node -> its aggregate, numbered from 0 in the order of the nodes that began
// them: a node and all around it, where none of those is taken. What is left
// joins the aggregate it is coupled to most.
class Aggregation {
 public:
  explicit Aggregation(const Matrix& coupled)
      : coupled_(coupled), aggregate_(coupled.cols(), kNoIndex) {
    for (Eigen::Index i = 0; i < coupled.cols(); ++i)
      if (IsFree(i)) Begin(i);
    const std::vector<uint32_t> first = aggregate_;
    for (Eigen::Index i = 0; i < coupled.cols(); ++i)
      if (aggregate_[i] == kNoIndex) Join(i, first);
  }

  uint32_t count() const { return count_; }
  uint32_t Of(Eigen::Index i) const { return aggregate_[i]; }

 private:
  bool IsFree(Eigen::Index i) const {
    if (aggregate_[i] != kNoIndex) return false;
    for (Matrix::InnerIterator entry(coupled_, i); entry; ++entry)
      if (aggregate_[entry.row()] != kNoIndex) return false;
    return true;
  }

  void Begin(Eigen::Index i) {
    aggregate_[i] = count_;
    for (Matrix::InnerIterator entry(coupled_, i); entry; ++entry)
      aggregate_[entry.row()] = count_;
    ++count_;
  }

  // What is not free has a neighbour that was taken first.
  void Join(Eigen::Index i, const std::vector<uint32_t>& first) {
    double most = 0;
    for (Matrix::InnerIterator entry(coupled_, i); entry; ++entry)
      if (first[entry.row()] != kNoIndex && entry.value() > most) {
        most = entry.value();
        aggregate_[i] = first[entry.row()];
      }
  }

  const Matrix& coupled_;
  std::vector<uint32_t> aggregate_;
  uint32_t count_ = 0;
};

// Each node has the mean of its aggregate's value and its neighbours'.
Matrix Prolongation(const Matrix& coupled, const Aggregation& aggregation) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(coupled.nonZeros() + coupled.cols());
  for (Eigen::Index i = 0; i < coupled.cols(); ++i) {
    const double sum = coupled.col(i).sum();
    const double own = sum > 0 ? 1 - kSmoothing : 1;
    entries.emplace_back(i, aggregation.Of(i), own);
    for (Matrix::InnerIterator entry(coupled, i); entry; ++entry)
      entries.emplace_back(i, aggregation.Of(entry.row()),
                           kSmoothing * entry.value() / sum);
  }
  Matrix P(coupled.cols(), aggregation.count());
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

Matrix Coarsen(const Matrix& fine, const Matrix& P) {
  const Matrix right = fine * P;
  return P.transpose() * right;
}

// x after one sweep of Gauss-Seidel from zero, first to last.
Eigen::VectorXd SweepDown(const Matrix& A, const Eigen::VectorXd& b) {
  Eigen::VectorXd x(b.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double rest = b[i];
    Matrix::InnerIterator entry(A, i);
    for (; entry.row() < i; ++entry) rest -= entry.value() * x[entry.row()];
    x[i] = rest / entry.value();
  }
  return x;
}

// The same from x on, last to first.
void SweepUp(const Matrix& A, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  for (Eigen::Index i = x.size(); i-- > 0;) {
    double rest = b[i], diagonal = 1;
    for (Matrix::InnerIterator entry(A, i); entry; ++entry) {
      if (entry.row() == i) {
        diagonal = entry.value();
      } else {
        rest -= entry.value() * x[entry.row()];
      }
    }
    x[i] = rest / diagonal;
  }
}

}  // namespace

Multigrid::Multigrid(const Laplacian& laplacian) {
  Level finest;
  finest.L = laplacian.L;
  finest.M.resize(laplacian.L.rows(), laplacian.L.cols());
  finest.M.setIdentity();
  finest.M.diagonal() = laplacian.M;
  levels_.push_back(std::move(finest));
  while (levels_.back().L.rows() > kDirect) {
    Level& fine = levels_.back();
    const Matrix coupled = Couplings(fine.L);
    const Aggregation aggregation(coupled);
    if (aggregation.count() > kLeastCoarsening * fine.L.rows()) break;
    fine.P = Prolongation(coupled, aggregation);
    Level coarse;
    coarse.L = Coarsen(fine.L, fine.P);
    coarse.M = Coarsen(fine.M, fine.P);
    levels_.push_back(std::move(coarse));
  }
}

void Multigrid::SetStep(double c) {
  for (Level& level : levels_) level.A = level.M + c * level.L;
  if (levels_.back().A.rows() <= kDirect)
    coarsest_.compute(Eigen::MatrixXd(levels_.back().A));
}

Eigen::VectorXd Multigrid::Cycle(size_t level, const Eigen::VectorXd& b) const {
  const Matrix& A = levels_[level].A;
  const Matrix& P = levels_[level].P;
  if (A.rows() <= kDirect) return coarsest_.solve(b);
  Eigen::VectorXd x = SweepDown(A, b);
  if (level + 1 < levels_.size())
    x += P * Cycle(level + 1, P.transpose() * (b - A * x));
  SweepUp(A, b, x);
  return x;
}

// Conjugate gradients.
int Multigrid::Solve(const Eigen::VectorXd& b, double tolerance,
                     const CancelToken& cancel, Eigen::VectorXd& x) const {
  const Matrix& A = levels_[0].A;
  Eigen::VectorXd r = b - A * x, direction;
  double before = 0;
  int steps = 0;
  for (; steps < kMaxSteps && r.norm() > tolerance * b.norm(); ++steps) {
    if (cancel.IsCancelled()) break;
    const Eigen::VectorXd z = Cycle(0, r);
    const double now = r.dot(z);
    direction = steps == 0 ? z : Eigen::VectorXd(z + now / before * direction);
    before = now;
    const Eigen::VectorXd image = A * direction;
    const double share = now / direction.dot(image);
    x += share * direction;
    r -= share * image;
  }
  return steps;
}

}  // namespace marrow
