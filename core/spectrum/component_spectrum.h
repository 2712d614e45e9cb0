// The spectrum of a mesh in several pieces.
#ifndef MARROW_CORE_SPECTRUM_COMPONENT_SPECTRUM_H_
#define MARROW_CORE_SPECTRUM_COMPONENT_SPECTRUM_H_

#include <cstdint>
#include <functional>

#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/canonical_mesh.h"
#include "core/spectrum/certified_spectrum.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Gives the lowest `count` pairs of a mesh besides the constant one, or all.
using SpectrumSolver = std::function<absl::StatusOr<CertifiedSpectrum>(
    const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
    const ProgressCallback& progress)>;

// The operator of a mesh in several components has no entry between them, but
// for the bridges that BuildLaplacian() adds and that are left out here: its
// pairs are those of the components, in the scale of the whole, with 0
// elsewhere, and as many zeros as there are components. So each component is
// solved by `solve` on its own, for as many pairs as the count turns out to
// take from it: pairs that are equal because components are do not meet in one
// solve. Of the zeros the first pair is the constant one; the others are
// constant on components. Equal eigenvalues come in the order of the
// components' least vertices.
//
// Where the mesh is one component, or has one without area, that is `solve`
// itself. Deterministic. Errors: those of `solve`; INTERNAL where it does not
// give all pairs of a component that is asked for all.
absl::StatusOr<CertifiedSpectrum> SolveByComponents(
    const CanonicalMesh& mesh, uint32_t count, const SpectrumSolver& solve,
    const CancelToken& cancel, const ProgressCallback& progress);

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_COMPONENT_SPECTRUM_H_
