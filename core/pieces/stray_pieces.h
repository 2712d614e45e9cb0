// Labels of faces -> labels that are in one piece.
#ifndef MARROW_CORE_PIECES_STRAY_PIECES_H_
#define MARROW_CORE_PIECES_STRAY_PIECES_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/adjacency.h"

namespace marrow {

// A label in several connected pieces keeps the one of most area (ties: the
// one with the least face); each other takes the label with which it shares the
// longest boundary, counted in edges and links, where there is one. So every
// label is in one piece afterwards where the mesh is; but pieces of more than
// `most` of the area of their label's largest stay where they are.
//
// `links` are pairs of faces that count as neighbours. Labels are less than
// `num_labels`. Deterministic.
void JoinStrayPieces(const Adjacency& adjacency,
                     const std::vector<double>& face_areas,
                     std::span<const std::array<uint32_t, 2>> links,
                     size_t num_labels, std::vector<uint32_t>& labels,
                     double most = 1);

// `is_patch`, by face: whether it fills a hole (core/mesh/patches.h); empty
// where no face does. A label that only patches have becomes that of faces
// beside it, or where there are none the least that is left, so that every
// label is of something that is there, if anything is.
void JoinPatches(const Adjacency& adjacency, const std::vector<bool>& is_patch,
                 std::vector<uint32_t>& labels);

}  // namespace marrow

#endif  // MARROW_CORE_PIECES_STRAY_PIECES_H_
