// How strong a boundary is: whether people would see two parts there.
//
// A cut between parts runs in one loop where the surface is saddle-shaped, and
// the surface widens beside it. All of that is seen from inside the surface, so
// a strength does not change when a joint bends.
#ifndef MARROW_CORE_BOUNDARIES_BOUNDARY_METER_H_
#define MARROW_CORE_BOUNDARIES_BOUNDARY_METER_H_

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/boundaries/curvature.h"
#include "core/boundaries/flood.h"
#include "core/boundaries/piece_graph.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// What is measured of a boundary of length L between two groups. Lengths and
// areas are those of a mesh of area 1; r = L / 2 pi, the radius of a round cut.
enum Measure : uint32_t {
  kConstant,        // 1
  kLength,          // log L
  kRelativeLength,  // log (L / sqrt(area of the smaller group))
  kLargerArea,      // log (area of the larger group)
  // How much of the cut runs through saddles, 0 to 1: the mean along it of the
  // logistic function of -(K r^2 + 0.1) / 0.15, K being the Gaussian curvature
  // at width r / 4. A share of places below a bound would be upset by places
  // near to that.
  kSaddleNear,
  kSaddleMiddle,  // the same at width r / 2
  kSaddleWide,    // at width r
  // log (area of the strip of breadth 2 r beside the cut, over 2 r L): 0 beside
  // a cut through a cylinder, more where the surface widens. Distances run
  // along edges.
  kStripOfSmaller,  // in the smaller group
  kStripOfLarger,
  kLargestLoop,  // share of L that is one connected part (loops.h)
  kNumMeasures
};
using Measures = std::array<double, kNumMeasures>;

// The probability, 0 to 1, that a boundary with these measures is kept: the
// logistic function of their sum weighted by core/boundaries/calibration.h.
double Strength(const Measures& measures);

// Measures boundaries of one mesh. Not thread safe. The referents must outlive
// it.
class BoundaryMeter {
 public:
  // `face_areas` are shares of the mesh's area; `share` is that area by that of
  // the largest body (of scenery less, core/operators/bodies.h), for in a crowd
  // a limb is as much of one as alone.
  BoundaryMeter(const TriangleMesh& mesh, const Adjacency& adjacency,
                const std::vector<double>& face_areas,
                const Curvature& curvature, double share = 1);

  // The strength of the boundary of two groups: Strength() times
  // s^2 / (s^2 + kSpeckShare^2), s being the area of the smaller group by that
  // of the largest body, for people draw no parts of a few faces, and none had
  // a say in the weights; beyond kAutomaticSalience it is ranked by how far the
  // groups are apart in the first split (core/boundaries/calibration.h). Where
  // no edge has faces of both they are of different shells, and it is s^2 /
  // (s^2 + kShellShare^2), s being the share of the shells of one group, and of
  // the group for which that is less: whoever made a shell of its own, and a
  // large one, made a part.
  double StrengthBetween(const PieceGraph& graph,
                         const PieceGraph::Pair& groups);

  // REQUIRES: the two groups have a boundary, with edges. Time: that of walking
  // all faces within 2 r of it. Symmetric in the groups' order.
  Measures MeasureBoundary(const PieceGraph& graph,
                           const PieceGraph::Pair& groups);

 private:
  // A cut and its two sides, the smaller group first.
  struct Cut {
    const PieceGraph& graph;
    const PieceGraph::Boundary& edges;
    std::array<uint32_t, 2> groups;
    double length;
    double radius;
  };

  // Whether so much is a part, 0 to 1; `half` of the area of the largest body
  // is one as likely as not.
  double AsPart(double area, double half) const;
  double EdgeLength(uint32_t a, uint32_t b) const;
  // kSaddle* at a width.
  double SaddleAlong(const Cut& cut, double width) const;
  void MeasureStrips(const Cut& cut, Measures& measures);

  const TriangleMesh& mesh_;
  const Adjacency& adjacency_;
  const std::vector<double>& face_areas_;
  const Curvature& curvature_;
  double share_;
  Positions unit_;
  std::vector<uint32_t> rim_of_vertex_;
  Flood flood_;
};

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_BOUNDARY_METER_H_
