// The time scale of a body that has several shells.
#ifndef MARROW_CORE_DIFFUSION_SHELL_SCALE_H_
#define MARROW_CORE_DIFFUSION_SHELL_SCALE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Eq. 10 takes the time at which the slowest mode of a mesh fades. A long staff
// in a hand, or a cart on a harness, is slower than all of the creature and
// hangs on it by a few bridges: by its time the legs would be one. So a body
// goes by its large shells, each as if it were alone, where that is sooner: by
// the one that is done first, for pieces that are too small merge again.
//
// Immutable, thread safe.
class ShellScale {
 public:
  // So many pairs, the constant one not counted, are what Slowest() makes use
  // of.
  static constexpr uint32_t kPairs = 24;

  // None, so that Slowest() is the first eigenvalue.
  ShellScale() = default;
  // Shells are what shared vertices connect, large ones those of at least
  // kLargeShell of the area. `bridges` join vertices of different shells.
  ShellScale(const TriangleMesh& mesh, const std::vector<double>& face_areas,
             std::span<const std::array<uint32_t, 2>> bridges);

  // Whether there is more than one shell, and one that is large.
  bool empty() const { return shells_.empty(); }

  // The eigenvalue that the time goes by: the greatest of the first ones of the
  // large shells, where it is a quarter more than that of the body, and else
  // that. The first one of a shell is what the first pairs, as they are on it,
  // come down to (Rayleigh and Ritz); their energy there is that of the body's
  // operator without the bridges.
  // REQUIRES: a pair besides the constant one.
  double Slowest(const EigenPairs& pairs) const;

 private:
  struct Shell {
    std::vector<uint32_t> vertices;                // ascending
    std::vector<std::array<uint32_t, 2>> bridges;  // from a vertex of it
  };

  double SlowestOf(const Shell& shell, const EigenPairs& pairs,
                   uint32_t count) const;

  std::vector<double> masses_;  // by vertex
  std::vector<Shell> shells_;
};

}  // namespace marrow

#endif  // MARROW_CORE_DIFFUSION_SHELL_SCALE_H_
