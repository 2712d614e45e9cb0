#include "core/pieces/fronts.h"

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "core/operators/laplacian.h"
#include "core/pieces/medial_structure.h"
#include "gtest/gtest.h"
#include "tests/testing/invariants.h"
#include "tests/testing/shapes.h"

namespace marrow {
namespace {

// The definition: as long as there are any, the least (key, face, front) of all
// faces that a front touches is claimed.
class NaiveCompetition {
 public:
  NaiveCompetition(const Region& region, const DiffusionMap& Phi,
                   const std::vector<Structure>& structures)
      : region_(region),
        Phi_(Phi),
        structures_(structures),
        owner_(region.NumFaces(), kNoIndex) {}

  std::vector<uint32_t> Run() {
    while (ClaimOne()) {
    }
    ClaimUnreached();
    return owner_;
  }

 private:
  double Key(uint32_t face, uint32_t front) const {
    double key = 0;
    for (uint32_t v : region_.triangles()[face]) {
      double least = std::numeric_limits<double>::infinity();
      for (uint32_t u : structures_[front])
        least = std::min(least, DiffusionDistance(Phi_, v, u));
      key = std::max(key, least);
    }
    return key;
  }

  bool Touches(uint32_t face, uint32_t front) const {
    for (uint32_t v : region_.triangles()[face])
      if (std::ranges::count(structures_[front], v)) return true;
    for (uint32_t e : region_.adjacency().FaceEdges(face))
      for (uint32_t f : region_.adjacency().EdgeFaces(e))
        if (owner_[f] == front) return true;
    return false;
  }

  bool ClaimOne() {
    std::tuple<double, uint32_t, uint32_t> best{
        std::numeric_limits<double>::infinity(), kNoIndex, kNoIndex};
    for (uint32_t face = 0; face < region_.NumFaces(); ++face)
      for (uint32_t front = 0; front < structures_.size(); ++front)
        if (owner_[face] == kNoIndex && Touches(face, front))
          best = std::min(best, {Key(face, front), face, front});
    if (std::get<1>(best) == kNoIndex) return false;
    owner_[std::get<1>(best)] = std::get<2>(best);
    return true;
  }

  void ClaimUnreached() {
    const std::vector<uint32_t> pieces = ConnectedPieces(
        region_.adjacency(), std::vector<uint32_t>(region_.NumFaces(), 0));
    std::map<uint32_t, std::vector<uint32_t>> unreached;
    for (uint32_t f = 0; f < region_.NumFaces(); ++f)
      if (owner_[f] == kNoIndex) unreached[pieces[f]].push_back(f);
    for (const auto& [piece, faces] : unreached) {
      std::vector<double> greatest(structures_.size(), 0);
      for (uint32_t front = 0; front < structures_.size(); ++front)
        for (uint32_t f : faces)
          greatest[front] = std::max(greatest[front], Key(f, front));
      for (uint32_t f : faces)
        owner_[f] = static_cast<uint32_t>(
            std::min_element(greatest.begin(), greatest.end()) -
            greatest.begin());
    }
  }

  const Region& region_;
  const DiffusionMap& Phi_;
  const std::vector<Structure>& structures_;
  std::vector<uint32_t> owner_;
};

DiffusionMap RandomMap(uint32_t rows, std::mt19937& random) {
  DiffusionMap Phi(rows, 4);
  for (Eigen::Index i = 0; i < Phi.size(); ++i)
    Phi.data()[i] = random() * 0x1p-32;
  return Phi;
}

std::vector<Structure> RandomStructures(uint32_t n, uint32_t count,
                                        uint32_t size, std::mt19937& random) {
  std::vector<Structure> structures;
  for (uint32_t i = 0; i < count; ++i) {
    std::set<uint32_t> chosen;
    for (uint32_t j = 0; j < size; ++j) chosen.insert(random() % n);
    structures.emplace_back(chosen.begin(), chosen.end());
  }
  return structures;
}

// About a quarter of the faces at the least, so that regions fall in pieces.
std::vector<uint32_t> RandomFaces(const TriangleMesh& mesh, uint32_t share,
                                  std::mt19937& random) {
  std::vector<uint32_t> faces;
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f)
    if (random() % 4 < share) faces.push_back(f);
  if (faces.empty()) faces.push_back(0);
  return faces;
}

TEST(CompeteFrontsTest, AgreesWithTheNaiveVersionOnRandomRegions) {
  const CancelToken cancel;
  std::mt19937 random(21);
  for (const auto& [name, mesh] : AllShapes()) {
    const Adjacency adjacency(mesh);
    const std::vector<double> areas = FaceAreaShares(mesh);
    for (uint32_t share : {2u, 3u, 4u}) {
      const Region region(mesh, adjacency, areas,
                          RandomFaces(mesh, share, random));
      if (region.NumFaces() > 500) continue;
      const DiffusionMap Phi = RandomMap(region.NumVertices(), random);
      for (uint32_t count : {1u, 3u}) {
        const auto structures =
            RandomStructures(region.NumVertices(), count, 3, random);
        EXPECT_EQ(CompeteFronts(region, MapSketch(Phi), structures, cancel),
                  NaiveCompetition(region, Phi, structures).Run())
            << name << ", share " << share << ", " << count << " fronts";
      }
    }
  }
}

// With all distances equal, the order of faces and fronts decides alone.
TEST(CompeteFrontsTest, TiesGoByFaceThenFront) {
  const CancelToken cancel;
  std::mt19937 random(22);
  const TriangleMesh mesh = Grid(8, 8);
  const Region region(mesh, Adjacency(mesh), FaceAreaShares(mesh),
                      RandomFaces(mesh, 4, random));
  const DiffusionMap Phi = DiffusionMap::Zero(region.NumVertices(), 2);
  for (uint32_t count : {2u, 5u}) {
    const auto structures =
        RandomStructures(region.NumVertices(), count, 2, random);
    EXPECT_EQ(CompeteFronts(region, MapSketch(Phi), structures, cancel),
              NaiveCompetition(region, Phi, structures).Run());
  }
}

TEST(CompeteFrontsTest, LargeStructuresAgreeWithTheNaiveVersionToo) {
  const CancelToken cancel;
  std::mt19937 random(23);
  const TriangleMesh mesh = Grid(15, 12);
  const Region region(mesh, Adjacency(mesh), FaceAreaShares(mesh),
                      RandomFaces(mesh, 4, random));
  const DiffusionMap Phi = RandomMap(region.NumVertices(), random);
  const auto structures = RandomStructures(region.NumVertices(), 2, 80, random);
  EXPECT_EQ(CompeteFronts(region, MapSketch(Phi), structures, cancel),
            NaiveCompetition(region, Phi, structures).Run());
}

TEST(CompeteFrontsTest, KnownDistancesAreUsedAndChangeNothing) {
  const CancelToken cancel;
  std::mt19937 random(26);
  const TriangleMesh mesh = Grid(9, 7);
  const Region region(mesh, Adjacency(mesh), FaceAreaShares(mesh),
                      RandomFaces(mesh, 4, random));
  const DiffusionMap Phi = RandomMap(region.NumVertices(), random);
  const auto structures = RandomStructures(region.NumVertices(), 3, 2, random);
  const MapSketch sketch(Phi);
  std::vector<FrontDistance> known(region.NumVertices());
  for (uint32_t v = 0; v < known.size(); ++v) {
    const uint32_t front = v % 3;
    known[v] = {front, 0, StructureDistance(sketch, structures[front])(v)};
  }
  const auto owners = CompeteFronts(region, MapSketch(Phi), structures, cancel);
  EXPECT_EQ(CompeteFronts(region, MapSketch(Phi), structures, cancel, known),
            owners);
  // Front 0 is told that it is far from everything.
  for (FrontDistance& entry : known) entry = {0, 0, 1e9};
  EXPECT_NE(CompeteFronts(region, MapSketch(Phi), structures, cancel, known),
            owners);
}

TEST(CompeteFrontsTest, ReturnsOnceCancelled) {
  CancelToken cancel;
  cancel.Cancel();
  std::mt19937 random(24);
  const TriangleMesh mesh = Grid(3, 3);
  const Region region(mesh, Adjacency(mesh), FaceAreaShares(mesh),
                      RandomFaces(mesh, 4, random));
  const DiffusionMap Phi = RandomMap(region.NumVertices(), random);
  EXPECT_EQ(CompeteFronts(region, MapSketch(Phi), {{0}}, cancel).size(),
            region.NumFaces());
}

// An edge of many faces: looking at all of them for each would be 10^10 steps.
TEST(CompeteFrontsTest, ABookOfManyPagesStaysQuick) {
  const CancelToken cancel;
  std::mt19937 random(25);
  const TriangleMesh mesh = Book(50'000, 1);
  const Region region(mesh, Adjacency(mesh),
                      std::vector<double>(mesh.NumFaces(), 1e-5),
                      RandomFaces(mesh, 4, random));
  const DiffusionMap Phi = RandomMap(region.NumVertices(), random);
  const auto owners =
      CompeteFronts(region, MapSketch(Phi), {{0}, {1}, {7}}, cancel);
  EXPECT_EQ(std::ranges::count(owners, kNoIndex), 0);
}

}  // namespace
}  // namespace marrow
