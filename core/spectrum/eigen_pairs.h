// The lowest eigen-pairs of a mesh's Laplace-Beltrami operator, and whoever can
// give them.
#ifndef MARROW_CORE_SPECTRUM_EIGEN_PAIRS_H_
#define MARROW_CORE_SPECTRUM_EIGEN_PAIRS_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/laplacian.h"

namespace marrow {

// Row-major: the rows are what the diffusion map reads.
using EigenvectorMatrix =
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// L phi = lambda M phi on the canonical mesh, scaled to area 1 (so lambda and
// the time scale t are dimensionless). Immutable once built.
struct EigenPairs {
  // Ascending; entry 0 is the constant pair's, exactly 0.
  Eigen::VectorXd eigenvalues;
  // n x pairs, a column an eigenvector, M-orthonormal as far as the solver's
  // tolerance allows; rounded to this precision after its residual was
  // certified.
  EigenvectorMatrix eigenvectors;
  // Area of the canonical mesh in the payload's units: an eigenvalue in those
  // units is lambda / area, an eigenvector phi / sqrt(area).
  double area = 0;
  // What it took to make an operator of the triangles.
  LaplacianReport laplacian;
  // Whether these are all the pairs of the mesh, so that no truncation of a
  // diffusion map can want more.
  bool complete = false;
  // Whether these are, to the byte, the first pairs of whoever asks for more,
  // and fewer of them those of whoever asks for fewer. So it is but where very
  // many eigenvalues are equal or most pairs of a mesh are wanted.
  bool for_any_count = true;
  // Where more than NumPairs(): all those that follow, up to this number at
  // least, have one eigenvalue, so that no diffusion map can end among them.
  uint32_t cluster_end = 0;

  // Number of pairs, the constant one counted.
  uint32_t NumPairs() const {
    return static_cast<uint32_t>(eigenvalues.size());
  }
  uint64_t Bytes() const {
    return sizeof(double) * eigenvalues.size() +
           sizeof(float) * eigenvectors.size();
  }
};

// The first `count` of them. REQUIRES: count < pairs.NumPairs().
EigenPairs FirstPairs(const EigenPairs& pairs, uint32_t count);

// Called with a share of the work, 0 to 1, never falling, on the thread that
// computes.
using ProgressCallback = std::function<void(double)>;

// The pairs of one mesh as far as they are needed. Not thread safe.
class EigenPairStream {
 public:
  virtual ~EigenPairStream() = default;

  // All pairs up to the eigenvalue `bound` and at least one beyond it, or as
  // many as the stream was opened for; more where more are at hand; fewer where
  // the bound is finite and cluster_end says that no more are of use. A longer
  // answer begins with the bytes of the shorter ones. Errors: as Get(), and
  // then the stream is not to be used any more.
  virtual absl::StatusOr<std::shared_ptr<const EigenPairs>> UpTo(
      double bound, const CancelToken& cancel,
      const ProgressCallback& progress) = 0;
};

class EigenPairSource {
 public:
  virtual ~EigenPairSource() = default;

  // At least min(count + 1, mesh.vertices) pairs, the constant one included.
  // REQUIRES: 2 <= count <= 1000. Thread safe. Errors: CANCELLED once `cancel`
  // is; INTERNAL with reason SOLVER_NOT_CONVERGED.
  virtual absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) = 0;

  // Whether what it gives for `count` pairs begins as what it gives for others,
  // as far as EigenPairs::for_any_count says so of both.
  virtual bool GivesSharedPairs(const CanonicalMesh&, uint32_t) const {
    return true;
  }

  // What Get() answers, piece by piece for those sources that work so; the
  // others give all of it at once. `mesh` and this must outlive the stream.
  virtual std::unique_ptr<EigenPairStream> Open(const CanonicalMesh& mesh,
                                                uint32_t count);
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_EIGEN_PAIRS_H_
