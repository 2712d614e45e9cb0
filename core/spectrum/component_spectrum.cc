#include "core/spectrum/component_spectrum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/status_macros.h"
#include "core/mesh/components.h"
#include "core/mesh/submesh.h"
#include "core/operators/laplacian.h"
#include "core/spectrum/certificate.h"

namespace marrow {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A component is first asked for this many times its share of the pairs, as
// eigenvalues lie about evenly over the area (Weyl's law), and some more.
constexpr double kFirstShare = 1.1;
constexpr uint32_t kFirstMore = 8;

struct Component {
  std::vector<uint32_t> faces;     // ascending
  std::vector<uint32_t> vertices;  // ascending
  double share = 0;                // of the area
  CanonicalMesh canonical;
  uint32_t asked = 0;
  CertifiedSpectrum spectrum;

  uint32_t NumVertices() const {
    return static_cast<uint32_t>(vertices.size());
  }
  bool IsComplete() const { return spectrum.NumPairs() == NumVertices(); }
  // In the scale of the whole.
  double Eigenvalue(uint32_t pair) const {
    return spectrum.eigenvalues[pair] / share;
  }
  // All pairs below it are known.
  double Bound() const {
    return IsComplete() ? kInfinity : spectrum.bound / share;
  }
};

// By their least vertices.
std::vector<Component> FindComponents(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.NumVertices());
  JoinCorners(mesh, sets);
  std::vector<Component> components;
  std::vector<uint32_t> number(mesh.NumVertices());
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    const uint32_t least = sets.Find(v);
    if (least == v) {
      number[v] = static_cast<uint32_t>(components.size());
      components.emplace_back();
    }
    components[number[least]].vertices.push_back(v);
  }
  const std::vector<double> areas = FaceAreaShares(mesh);
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    Component& component = components[number[sets.Find(mesh.faces[f][0])]];
    component.faces.push_back(f);
    component.share += areas[f];
  }
  return components;
}

struct Pair {
  double eigenvalue;
  uint32_t component;
  uint32_t index;  // among the component's
};

class ComponentsSolver {
 public:
  ComponentsSolver(const CanonicalMesh& mesh, uint32_t count,
                   const SpectrumSolver& solve, const CancelToken& cancel,
                   const ProgressCallback& progress)
      : mesh_(mesh),
        total_(std::min(count, mesh.mesh.NumVertices() - 1) + 1),
        solve_(solve),
        cancel_(cancel),
        progress_(progress),
        components_(FindComponents(mesh.mesh)) {}

  // Whether each has an area, without which it has no scale.
  bool CanSolve() const {
    return std::all_of(components_.begin(), components_.end(),
                       [](const Component& c) { return c.share > 0; });
  }

  absl::StatusOr<CertifiedSpectrum> Solve() {
    if (total_ > components_.size()) MARROW_RETURN_IF_ERROR(SolveEach());
    Assemble();
    MARROW_RETURN_IF_ERROR(cancel_.Check());
    return std::move(spectrum_);
  }

 private:
  absl::Status SolveEach() {
    const double wanted = total_ - static_cast<double>(components_.size());
    double done = 0;
    for (Component& component : components_) {
      component.canonical = ExtractFaces(mesh_.mesh, component.faces).canonical;
      const double share = component.NumVertices() /
                           static_cast<double>(mesh_.mesh.NumVertices());
      const auto first =
          static_cast<uint32_t>(kFirstShare * wanted * component.share);
      MARROW_RETURN_IF_ERROR(Ask(component, first + kFirstMore, [&](double x) {
        progress_(done + share * x);
      }));
      done += share;
    }
    // The last of the pairs may have more below it that were not asked for.
    while (true) {
      const std::vector<Pair> known = Known();
      const double last =
          known.size() < total_ ? kInfinity : known[total_ - 1].eigenvalue;
      bool all = true;
      for (Component& component : components_) {
        if (component.IsComplete() ||
            component.Bound() > last * (1 + kCountableGap))
          continue;
        all = false;
        if (component.asked == component.NumVertices() - 1)
          return absl::InternalError("a component's pairs end early");
        MARROW_RETURN_IF_ERROR(
            Ask(component, 2 * component.asked, [](double) {}));
      }
      if (all) return absl::OkStatus();
    }
  }

  absl::Status Ask(Component& component, uint32_t count,
                   const ProgressCallback& progress) {
    component.asked = std::min(count, component.NumVertices() - 1);
    MARROW_ASSIGN_OR_RETURN(
        component.spectrum,
        solve_(component.canonical, component.asked, cancel_, progress));
    return absl::OkStatus();
  }

  // Those besides the zeros, ascending, behind a place for each zero.
  std::vector<Pair> Known() const {
    std::vector<Pair> known(components_.size(), Pair{0, 0, 0});
    for (uint32_t c = 0; c < components_.size(); ++c)
      for (uint32_t k = 1; k < components_[c].spectrum.NumPairs(); ++k)
        known.push_back({components_[c].Eigenvalue(k), c, k});
    std::sort(known.begin() + static_cast<int64_t>(components_.size()),
              known.end(), [](const Pair& x, const Pair& y) {
                return std::tie(x.eigenvalue, x.component, x.index) <
                       std::tie(y.eigenvalue, y.component, y.index);
              });
    return known;
  }

  void Assemble() {
    spectrum_.area = mesh_.report.area;
    spectrum_.complete = total_ == mesh_.mesh.NumVertices();
    spectrum_.eigenvalues.setZero(total_);
    spectrum_.residuals.setZero(total_);
    spectrum_.eigenvectors.setZero(mesh_.mesh.NumVertices(), total_);
    AddZeros();
    const std::vector<Pair> known = Known();
    for (uint32_t k = static_cast<uint32_t>(components_.size()); k < total_;
         ++k) {
      const auto& [eigenvalue, c, index] = known[k];
      const Component& component = components_[c];
      spectrum_.eigenvalues[k] = eigenvalue;
      spectrum_.residuals[k] = component.spectrum.residuals[index];
      const double scale = 1 / std::sqrt(component.share);
      for (uint32_t v = 0; v < component.NumVertices(); ++v)
        spectrum_.eigenvectors(component.vertices[v], k) =
            scale * component.spectrum.eigenvectors(v, index);
    }
    Bound(known);
  }

  // The constant, and for every further component one that is constant on it
  // and on those before together, and orthogonal to the constant there.
  void AddZeros() {
    spectrum_.eigenvectors.col(0).setOnes();
    double before = 0;
    for (uint32_t c = 0; c < components_.size() && c < total_; ++c) {
      const double own = components_[c].share;
      if (c > 0) {
        const double scale = 1 / std::sqrt(own * before * (own + before));
        for (uint32_t other = 0; other <= c; ++other)
          for (uint32_t v : components_[other].vertices)
            spectrum_.eigenvectors(v, c) = scale * (other == c ? -before : own);
      }
      before += own;
    }
  }

  // The last gap that a count can tell, and that all components know of. Among
  // the zeros there is none.
  void Bound(const std::vector<Pair>& known) {
    if (total_ <= components_.size()) return;
    double highest = kInfinity;
    for (const Component& component : components_)
      highest = std::min(highest, component.Bound());
    const auto bound_above = [&](uint32_t pairs) {
      const double low = known[pairs - 1].eigenvalue;
      const double high = pairs < known.size() ? known[pairs].eigenvalue
                                               : low * (1 + 4 * kCountableGap);
      return std::min(highest, 0.5 * (low + high));
    };
    uint32_t pairs = total_;
    while (pairs > components_.size() &&
           bound_above(pairs) <=
               known[pairs - 1].eigenvalue * (1 + kCountableGap))
      --pairs;
    spectrum_.bound = bound_above(pairs);
    spectrum_.count_below_bound = pairs;
  }

  const CanonicalMesh& mesh_;
  const uint32_t total_;
  const SpectrumSolver& solve_;
  const CancelToken& cancel_;
  const ProgressCallback& progress_;
  std::vector<Component> components_;
  CertifiedSpectrum spectrum_;
};

}  // namespace

absl::StatusOr<CertifiedSpectrum> SolveByComponents(
    const CanonicalMesh& mesh, uint32_t count, const SpectrumSolver& solve,
    const CancelToken& cancel, const ProgressCallback& progress) {
  if (mesh.report.components <= 1) return solve(mesh, count, cancel, progress);
  const ProgressCallback report = progress ? progress : [](double) {};
  ComponentsSolver solver(mesh, count, solve, cancel, report);
  return solver.CanSolve() ? solver.Solve()
                           : solve(mesh, count, cancel, progress);
}

}  // namespace marrow
