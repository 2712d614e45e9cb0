// The trees of the bodies of a mesh -> one tree over the whole mesh.
#ifndef MARROW_CORE_HIERARCHY_FOREST_H_
#define MARROW_CORE_HIERARCHY_FOREST_H_

#include <cstdint>
#include <vector>

#include "core/hierarchy/segment_tree.h"
#include "core/mesh/canonical_mesh.h"
#include "core/operators/bodies.h"

namespace marrow {

// What becomes of the roots of several bodies.
enum class BodyRoots {
  kLevelOne,  // they are the root's children, and levels are one deeper
  // The root stands for them, of salience 1, and level k is made of level k of
  // each; where a body is not split, its root is of level 1.
  kNone,
};

// Where there is one body, its tree with the attached faces added to the nodes
// whose faces they are anchored to. Where there are several, the nodes of one
// level are in the order of the bodies, and the root's medial structure is that
// of the largest. Areas and centroids are those of the faces of each node.
//
// `face_areas` are shares of the whole mesh's area. Grows with the trees: when
// those have been deepened by a level, nodes are added behind those there
// were. REQUIRES: a tree for each body, on its own faces. Thread safe.
SegmentTree PlantForest(const CanonicalMesh& mesh,
                        const std::vector<double>& face_areas,
                        const Bodies& bodies,
                        const std::vector<const SegmentTree*>& trees,
                        BodyRoots roots);

}  // namespace marrow

#endif  // MARROW_CORE_HIERARCHY_FOREST_H_
