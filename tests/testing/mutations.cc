#include "tests/testing/mutations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "tests/testing/shapes.h"

namespace marrow {
namespace {

class Mutator {
 public:
  explicit Mutator(uint32_t seed) : random_(seed) {}

  Mutation Run() {
    PickMesh();
    for (uint32_t kinds = 1 + Below(5); kinds > 0; --kinds) Damage();
    // Later damage may have put a number where there was none.
    result_.has_nan = mesh().positions.hasNaN();
    return std::move(result_);
  }

 private:
  // Standard engines are the same everywhere; standard distributions are not.
  uint32_t Below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  double Share() { return random_() / 4294967296.0; }
  double Signed() { return 2 * Share() - 1; }
  uint32_t AnyFace() { return Below(mesh().NumFaces()); }
  uint32_t AnyVertex() { return Below(mesh().NumVertices()); }
  TriangleMesh& mesh() { return result_.mesh; }

  // Now and then many, mostly few.
  uint32_t Some(uint32_t of) {
    const double share = Share();
    return 1 + static_cast<uint32_t>(share * share * share * 0.5 * of);
  }

  double Extent() {
    return (mesh().positions.colwise().maxCoeff() -
            mesh().positions.colwise().minCoeff())
        .maxCoeff();
  }

  void PickMesh() {
    const std::vector<NamedMesh>& shapes = Shapes();
    const NamedMesh& shape = shapes[Below(shapes.size())];
    mesh() = shape.mesh;
    result_.history = shape.name + ":";
  }

  static const std::vector<NamedMesh>& Shapes() {
    static const auto* shapes = new std::vector<NamedMesh>{
        {"tetrahedron", Tetrahedron()},
        {"sphere", Icosphere(2)},
        {"finer sphere", Icosphere(3)},
        {"torus", Torus(2, 0.7, 30, 12)},
        {"disk", Disk(10)},
        {"strip", Grid(80, 3)},
        {"dumbbell", Dumbbell(0.8, 16)},
        {"cross", LimbCross(2)},
        {"book", Book(4, 40)},
        {"blocks", CubeShells({{0, 0, 0},
                               {0, 0, 1},
                               {0, 0, 2},
                               {0, 1, 1},
                               {0, 2, 1},
                               {1, 0, 2},
                               {-1, 0, 2},
                               {-2, 0, 2}},
                              2)},
        {"grids", TouchingGrids()},
    };
    return *shapes;
  }

  void Damage() {
    struct Kind {
      const char* name;
      void (Mutator::*once)();
      bool of_vertices;
    };
    static constexpr Kind kKinds[] = {
        {"delete face", &Mutator::DeleteFace, false},
        {"flip face", &Mutator::FlipFace, false},
        {"duplicate face", &Mutator::DuplicateFace, false},
        {"move corner", &Mutator::MoveCorner, false},
        {"merge vertices", &Mutator::MergeVertices, true},
        {"split vertex", &Mutator::SplitVertex, true},
        {"nudge vertex", &Mutator::NudgeVertex, true},
        {"throw vertex", &Mutator::ThrowVertex, true},
        {"stack vertex", &Mutator::StackVertex, true},
        {"add speck", &Mutator::AddSpeck, true},
    };
    const uint32_t kind = Below(std::size(kKinds) + 2);
    uint32_t times = 1;
    const char* name = "";
    if (kind < std::size(kKinds)) {
      name = kKinds[kind].name;
      times = Some(kKinds[kind].of_vertices ? mesh().NumVertices()
                                            : mesh().NumFaces());
      for (uint32_t i = 0; i < times; ++i) (this->*kKinds[kind].once)();
    } else if (kind == std::size(kKinds)) {
      name = "add shell";
      AddShell();
    } else if (Below(4) == 0) {
      name = "NaN";
      mesh().positions(AnyVertex(), Below(3)) =
          std::numeric_limits<double>::quiet_NaN();
    } else {
      return;
    }
    result_.history += std::string(" ") + name + " x" + std::to_string(times);
  }

  void DeleteFace() {
    if (mesh().NumFaces() == 1) return;
    mesh().faces.erase(mesh().faces.begin() + AnyFace());
  }
  void FlipFace() {
    Triangle& face = mesh().faces[AnyFace()];
    std::swap(face[0], face[1]);
  }
  void DuplicateFace() {
    Triangle face = mesh().faces[AnyFace()];
    std::rotate(face.begin(), face.begin() + Below(3), face.end());
    mesh().faces.push_back(face);
  }
  void MoveCorner() { mesh().faces[AnyFace()][Below(3)] = AnyVertex(); }

  // The ends of an edge, or any two.
  std::pair<uint32_t, uint32_t> TwoVertices() {
    if (Below(4) == 0) return {AnyVertex(), AnyVertex()};
    const Triangle face = mesh().faces[AnyFace()];
    return {face[0], face[1]};
  }
  void MergeVertices() {
    const auto [from, to] = TwoVertices();
    for (Triangle& face : mesh().faces)
      for (uint32_t& corner : face)
        if (corner == from) corner = to;
  }
  // One face gets its corner for itself, a little aside.
  void SplitVertex() {
    const uint32_t n = mesh().NumVertices();
    uint32_t& corner = mesh().faces[AnyFace()][Below(3)];
    mesh().positions.conservativeResize(n + 1, 3);
    mesh().positions.row(n) = mesh().positions.row(corner);
    corner = n;
    Move(n, Below(2) == 0 ? 0 : 1e-3);
  }
  void Move(uint32_t v, double by) {
    for (int i = 0; i < 3; ++i) mesh().positions(v, i) += by * Signed();
  }
  void NudgeVertex() { Move(AnyVertex(), 0.3); }
  void ThrowVertex() { Move(AnyVertex(), std::pow(10.0, 8 * Share() - 2)); }
  void StackVertex() {
    const auto [from, to] = TwoVertices();
    mesh().positions.row(from) = mesh().positions.row(to);
  }
  void AddSpeck() {
    const uint32_t n = mesh().NumVertices();
    const uint32_t near = AnyVertex();
    mesh().positions.conservativeResize(n + 3, 3);
    for (uint32_t i = 0; i < 3; ++i) {
      mesh().positions.row(n + i) = mesh().positions.row(near);
      Move(n + i, 0.01);
    }
    mesh().faces.push_back({n, n + 1, n + 2});
  }
  void AddShell() {
    if (mesh().NumFaces() > 2'000) return;
    const TriangleMesh shell = Scaled(Rotated(mesh(), {1, 2, 3}, 3 * Share()),
                                      std::pow(2.0, 3 * Signed()));
    const uint32_t n = mesh().NumVertices();
    mesh().positions.conservativeResize(n + shell.NumVertices(), 3);
    mesh().positions.bottomRows(shell.NumVertices()) = shell.positions;
    for (const auto& [a, b, c] : shell.faces)
      mesh().faces.push_back({n + a, n + b, n + c});
  }

  std::mt19937 random_;
  Mutation result_;
};

}  // namespace

Mutation MakeMutation(uint32_t seed) { return Mutator(seed).Run(); }

}  // namespace marrow
