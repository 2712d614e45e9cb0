#include "tests/bench/spectrum_runs.h"

#include <sys/resource.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status_macros.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/certified_spectrum.h"
#include "core/spectrum/reference_solver.h"
#include "core/spectrum/solver.h"
#include "core/spectrum/strict_solver.h"
#include "tests/bench/bench_mesh.h"

namespace marrow {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

static_assert(std::endian::native == std::endian::little);

double Seconds(Clock::time_point since) {
  return std::chrono::duration<double>(Clock::now() - since).count();
}

uint64_t PeakBytes() {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) << 10;
}

template <typename T>
absl::Status Write(const std::string& path, const T* values, size_t count) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values),
             static_cast<std::streamsize>(count * sizeof(T)));
  return file.flush() ? absl::OkStatus()
                      : absl::UnknownError(absl::StrCat("cannot write ", path));
}

template <typename T>
absl::StatusOr<std::vector<T>> Read(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return absl::NotFoundError(absl::StrCat("cannot read ", path));
  std::vector<T> values(static_cast<size_t>(file.tellg()) / sizeof(T));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
  return values;
}

absl::StatusOr<Laplacian> ReadMatrices(const std::string& folder) {
  MARROW_ASSIGN_OR_RETURN(auto starts, Read<int>(folder + "/starts.i32"));
  MARROW_ASSIGN_OR_RETURN(auto rows, Read<int>(folder + "/rows.i32"));
  MARROW_ASSIGN_OR_RETURN(auto values, Read<double>(folder + "/values.f64"));
  MARROW_ASSIGN_OR_RETURN(auto mass, Read<double>(folder + "/mass.f64"));
  const Eigen::Index n = static_cast<Eigen::Index>(mass.size());
  Laplacian laplacian;
  laplacian.L = Eigen::Map<const Eigen::SparseMatrix<double>>(
      n, n, static_cast<Eigen::Index>(values.size()), starts.data(),
      rows.data(), values.data());
  laplacian.M = Eigen::Map<const Eigen::VectorXd>(mass.data(), n);
  return laplacian;
}

absl::StatusOr<CanonicalMesh> ReadMesh(const std::string& folder) {
  MARROW_ASSIGN_OR_RETURN(auto positions,
                          Read<double>(folder + "/positions.f64"));
  MARROW_ASSIGN_OR_RETURN(auto faces, Read<uint32_t>(folder + "/faces.i32"));
  DecodedMesh mesh;
  mesh.positions = Eigen::Map<const Positions>(
      positions.data(), static_cast<Eigen::Index>(positions.size() / 3), 3);
  for (size_t f = 0; f + 2 < faces.size(); f += 3)
    mesh.faces.push_back({faces[f], faces[f + 1], faces[f + 2]});
  return Canonicalize(mesh);
}

// As certified_spectrum.h has it.
double WorstResidual(const Laplacian& laplacian, const Eigen::VectorXd& lambda,
                     const auto& vectors) {
  double worst = 0;
  for (Eigen::Index k = 1; k < lambda.size(); ++k) {
    const Eigen::VectorXd phi = vectors.col(k).template cast<double>();
    const Eigen::VectorXd rest =
        laplacian.L * phi - lambda[k] * laplacian.M.cwiseProduct(phi);
    worst = std::max(
        worst, std::sqrt(rest.cwiseAbs2().cwiseQuotient(laplacian.M).sum()) /
                   lambda[k]);
  }
  return worst;
}

json Result(double seconds, uint64_t peak, const Laplacian& laplacian,
            const Eigen::VectorXd& lambda, const auto& vectors) {
  return {{"seconds", seconds},
          {"peak_bytes", peak},
          {"residual", WorstResidual(laplacian, lambda, vectors)},
          {"eigenvalues", std::vector<double>(lambda.begin(), lambda.end())}};
}

// Marrow's solver takes a mesh. Its time to make L and M of it is measured by
// itself and taken off.
//
// `solve` takes the mesh and gives a pointer to pairs.
template <typename Solve>
absl::StatusOr<json> RunMarrow(const std::string& folder, const Solve& solve) {
  MARROW_ASSIGN_OR_RETURN(const CanonicalMesh mesh, ReadMesh(folder));
  auto start = Clock::now();
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian, BuildLaplacian(mesh.mesh));
  const double operator_seconds = Seconds(start);
  start = Clock::now();
  MARROW_ASSIGN_OR_RETURN(const auto found, solve(mesh));
  const double seconds = Seconds(start) - operator_seconds;
  return Result(seconds, PeakBytes(), laplacian, found->eigenvalues,
                found->eigenvectors);
}

absl::StatusOr<json> RunUsual(const std::string& folder, uint32_t pairs) {
  return RunMarrow(folder, [pairs](const CanonicalMesh& mesh) {
    return SolverEigenPairSource().Get(mesh, pairs, CancelToken(), nullptr);
  });
}

absl::StatusOr<json> RunStrict(const std::string& folder, uint32_t pairs) {
  using Found = std::unique_ptr<CertifiedSpectrum>;
  return RunMarrow(
      folder, [pairs](const CanonicalMesh& mesh) -> absl::StatusOr<Found> {
        MARROW_ASSIGN_OR_RETURN(
            CertifiedSpectrum spectrum,
            SolveStrictly(mesh, pairs, CancelToken(), nullptr));
        return std::make_unique<CertifiedSpectrum>(std::move(spectrum));
      });
}

absl::StatusOr<json> RunSpectra(const std::string& folder, uint32_t pairs) {
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian, ReadMatrices(folder));
  const CancelToken cancel;
  const auto start = Clock::now();
  const Eigen::VectorXd scale = laplacian.M.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> A =
      scale.asDiagonal() * laplacian.L * scale.asDiagonal();
  MARROW_ASSIGN_OR_RETURN(
      MatrixPairs found,
      SolveByReference(A, static_cast<int>(pairs) + 1, cancel, nullptr));
  found.vectors = scale.asDiagonal() * found.vectors;
  const double seconds = Seconds(start);
  return Result(seconds, PeakBytes(), laplacian, found.values, found.vectors);
}

}  // namespace

absl::StatusOr<json> WriteProblem(const std::string& path, uint32_t vertices,
                                  const std::string& folder) {
  MARROW_ASSIGN_OR_RETURN(const BenchMesh picked, PickMesh(path, vertices));
  const TriangleMesh& mesh = picked.canonical.mesh;
  MARROW_ASSIGN_OR_RETURN(const Laplacian laplacian, BuildLaplacian(mesh));
  const auto& L = laplacian.L;
  const size_t n = mesh.NumVertices(), entries = L.nonZeros();
  MARROW_RETURN_IF_ERROR(
      Write(folder + "/starts.i32", L.outerIndexPtr(), n + 1));
  MARROW_RETURN_IF_ERROR(
      Write(folder + "/rows.i32", L.innerIndexPtr(), entries));
  MARROW_RETURN_IF_ERROR(Write(folder + "/values.f64", L.valuePtr(), entries));
  MARROW_RETURN_IF_ERROR(Write(folder + "/mass.f64", laplacian.M.data(), n));
  MARROW_RETURN_IF_ERROR(
      Write(folder + "/positions.f64", mesh.positions.data(), 3 * n));
  MARROW_RETURN_IF_ERROR(
      Write(folder + "/faces.i32", mesh.faces.data(), mesh.faces.size()));
  return json{{"mesh", picked.name},
              {"vertices", mesh.NumVertices()},
              {"faces", mesh.NumFaces()}};
}

absl::StatusOr<json> RunSolver(const std::string& solver,
                               const std::string& folder, uint32_t pairs) {
  if (solver == "marrow") return RunUsual(folder, pairs);
  if (solver == "strict") return RunStrict(folder, pairs);
  if (solver == "spectra") return RunSpectra(folder, pairs);
  return absl::InvalidArgumentError(absl::StrCat(
      "there is no solver '", solver, "': choose marrow, strict or spectra"));
}

absl::StatusOr<json> CountBelow(const std::string& folder, double bound) {
  MARROW_ASSIGN_OR_RETURN(Laplacian laplacian, ReadMatrices(folder));
  laplacian.L.diagonal() -= bound * laplacian.M;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(laplacian.L);
  if (factor.info() != Eigen::Success)
    return absl::InternalError("a pivot vanished: choose another bound");
  return json{{"count", (factor.vectorD().array() < 0).count()}};
}

}  // namespace marrow
