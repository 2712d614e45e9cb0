#include "core/pieces/stray_pieces.h"

#include <vector>

#include "core/operators/laplacian.h"
#include "gtest/gtest.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

std::vector<uint32_t> Columns(const TriangleMesh& mesh,
                              const std::vector<uint32_t>& label_of_column) {
  std::vector<uint32_t> labels;
  for (const auto& [a, b, c] : mesh.faces)
    labels.push_back(label_of_column[static_cast<size_t>(
        (mesh.Position(a) + mesh.Position(b) + mesh.Position(c)).x() / 3)]);
  return labels;
}

std::vector<uint32_t> Joined(const TriangleMesh& mesh,
                             std::vector<uint32_t> labels, size_t count) {
  JoinStrayPieces(Adjacency(mesh), FaceAreaShares(mesh), {}, count, labels);
  return labels;
}

TEST(JoinStrayPiecesTest, TheLargestStaysAndOthersJoinTheirNeighbour) {
  const TriangleMesh mesh = Grid(7, 2);
  EXPECT_EQ(Joined(mesh, Columns(mesh, {0, 0, 0, 1, 1, 0, 1}), 2),
            Columns(mesh, {0, 0, 0, 1, 1, 1, 1}));
}

TEST(JoinStrayPiecesTest, AStrayBehindAStrayIsReachedToo) {
  const TriangleMesh mesh = Grid(9, 2);
  EXPECT_EQ(Joined(mesh, Columns(mesh, {0, 0, 0, 1, 1, 1, 0, 1, 0}), 2),
            Columns(mesh, {0, 0, 0, 1, 1, 1, 1, 1, 1}));
}

TEST(JoinPatchesTest, EveryLabelIsOfSomethingThatIsThere) {
  const TriangleMesh mesh = Grid(6, 2);
  std::vector<uint32_t> labels = Columns(mesh, {0, 0, 2, 3, 1, 1});
  std::vector<bool> is_patch;
  for (uint32_t label : labels) is_patch.push_back(label > 1);
  JoinPatches(Adjacency(mesh), is_patch, labels);
  EXPECT_EQ(labels, Columns(mesh, {0, 0, 0, 1, 1, 1}));
  // Beside nothing that is there.
  const TriangleMesh apart = Apart(Grid(1, 1), Grid(1, 1));
  std::vector<uint32_t> alone = {1, 1, 0, 0};
  JoinPatches(Adjacency(apart), {false, false, true, true}, alone);
  EXPECT_EQ(alone, std::vector<uint32_t>(4, 1));
  const std::vector<uint32_t> before = Columns(mesh, {0, 0, 2, 3, 1, 1});
  labels = before;
  JoinPatches(Adjacency(mesh), {}, labels);
  EXPECT_EQ(labels, before);
}

TEST(JoinStrayPiecesTest, WhatIsInOnePieceStays) {
  const TriangleMesh mesh = Grid(6, 2);
  const std::vector<uint32_t> labels = Columns(mesh, {2, 2, 0, 0, 1, 1});
  EXPECT_EQ(Joined(mesh, labels, 3), labels);
}

}  // namespace
}  // namespace marrow
