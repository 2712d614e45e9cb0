// The mode that the time scale of a body goes by.
#ifndef MARROW_CORE_DIFFUSION_SLOWEST_MODE_H_
#define MARROW_CORE_DIFFUSION_SLOWEST_MODE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/spectrum/eigen_pairs.h"

namespace marrow {

// Eq. 10 takes the time at which the slowest mode of a mesh fades. By the time
// of some modes all of a creature would be one:
//  - That of a spike, of one vertex or triangle far out of the surface, or of a
//    tail as thin as that. It lives on little area. So where the first mode
//    that is spread over more of it is much faster, the time goes by that one.
//  - That of a long staff in a hand, or of a cart on a harness, which hangs on
//    the creature by a few bridges. So a body goes by its large shells, each as
//    if it were alone, where that is sooner: by the one that is done first, for
//    pieces that are too small merge again.
//
// Immutable, thread safe.
class SlowestMode {
 public:
  // So many pairs, the constant one not counted, are what Of() makes use of.
  static constexpr uint32_t kPairs = 24;

  // Shells are what shared vertices connect, large ones those of at least
  // kLargeShell of the area. `bridges` join vertices of different shells.
  SlowestMode(const TriangleMesh& mesh, const std::vector<double>& face_areas,
              std::span<const std::array<uint32_t, 2>> bridges);

  // Whether Of() would not change with more pairs.
  bool IsKnownFrom(const EigenPairs& pairs) const;

  // The eigenvalue that the time goes by: the first one, or, where it is more
  // than that by the factors below, that of the first spread mode, or the
  // greatest of the first ones of the large shells. The first one of a shell is
  // what the first pairs, as they are on it, come down to (Rayleigh and Ritz);
  // their energy there is that of the body's operator without the bridges.
  // REQUIRES: a pair besides the constant one.
  double Of(const EigenPairs& pairs) const;

 private:
  struct Shell {
    std::vector<uint32_t> vertices;                // ascending
    std::vector<std::array<uint32_t, 2>> bridges;  // from a vertex of it
  };

  bool IsSpread(const EigenPairs& pairs, uint32_t pair) const;
  // 0 where none of the first pairs is.
  uint32_t FirstSpread(const EigenPairs& pairs) const;
  double FirstOf(const Shell& shell, const EigenPairs& pairs,
                 uint32_t count) const;

  std::vector<double> masses_;  // by vertex
  std::vector<Shell> shells_;   // none where there is one shell, or none large
};

}  // namespace marrow

#endif  // MARROW_CORE_DIFFUSION_SLOWEST_MODE_H_
