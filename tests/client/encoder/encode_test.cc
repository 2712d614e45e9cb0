#include "client/encoder/encode.h"

#include <draco/compression/decode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "client/mesh_file/triangulate.h"
#include "client/segmentation.h"
#include "core/mesh/decode.h"
#include "tests/client/encoder/shapes.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

// The bits of a position, so that equality is to the bit.
using Place = std::array<uint64_t, 3>;
using TrianglePlaces = std::array<Place, 3>;

Place PlaceOf(const std::array<double, 3>& p) {
  return std::bit_cast<Place>(p);
}

Place PlaceOf(const DecodedMesh& decoded, uint32_t point) {
  return PlaceOf({decoded.positions(point, 0), decoded.positions(point, 1),
                  decoded.positions(point, 2)});
}

template <typename Lookup>
TrianglePlaces SortedPlaces(const std::array<uint32_t, 3>& corners,
                            const Lookup& lookup) {
  TrianglePlaces places = {lookup(corners[0]), lookup(corners[1]),
                           lookup(corners[2])};
  std::sort(places.begin(), places.end());
  return places;
}

// Where the triangles of a mesh are -> the first face that has one there.
// Nothing here knows of ids that went through Draco: geometry alone decides.
class FaceFinder {
 public:
  explicit FaceFinder(const PolygonMesh& mesh) {
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
      std::vector<std::array<uint32_t, 3>> triangles;
      Triangulate(mesh, f, &triangles);
      for (const auto& triangle : triangles) {
        const TrianglePlaces key = SortedPlaces(
            triangle, [&](uint32_t v) { return PlaceOf(mesh.positions[v]); });
        face_at_.try_emplace(key, f);
        places_of_face_[f].push_back(key);
      }
    }
  }

  // Fails unless some face of the file is there, to the bit.
  uint32_t Find(const TrianglePlaces& places) const {
    const auto entry = face_at_.find(places);
    EXPECT_NE(entry, face_at_.end()) << "a decoded face is none of the file";
    return entry == face_at_.end() ? 0 : entry->second;
  }
  // The label that a face must come back with: its own number, or that of the
  // first face in the same place.
  uint32_t Expected(uint32_t face) const {
    return face_at_.at(places_of_face_.at(face).front());
  }

 private:
  std::map<TrianglePlaces, uint32_t> face_at_;
  std::map<uint32_t, std::vector<TrianglePlaces>> places_of_face_;
};

bool HasThreePlaces(const PolygonMesh& mesh, size_t f) {
  std::vector<Place> places;
  for (const uint32_t v : mesh.Face(f)) {
    places.push_back(PlaceOf(mesh.positions[v]));
  }
  std::sort(places.begin(), places.end());
  return std::unique(places.begin(), places.end()) - places.begin() >= 3;
}

void ExpectFacesComeBack(const PolygonMesh& mesh, const DecodedMesh& decoded,
                         const OrderMap& order) {
  const FaceFinder finder(mesh);
  std::vector<uint32_t> labels;
  for (const Triangle& face : decoded.faces) {
    labels.push_back(finder.Find(
        SortedPlaces(face, [&](uint32_t p) { return PlaceOf(decoded, p); })));
  }
  const auto in_file_order = order.FaceLabelsInFileOrder(labels);
  ASSERT_TRUE(in_file_order.ok()) << in_file_order.status();
  ASSERT_EQ(in_file_order->size(), mesh.NumFaces());
  for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
    if (!HasThreePlaces(mesh, f)) continue;
    ASSERT_EQ((*in_file_order)[f], finder.Expected(f)) << "face " << f;
  }
}

void ExpectVerticesComeBack(const PolygonMesh& mesh, const DecodedMesh& decoded,
                            const OrderMap& order) {
  std::map<Place, uint32_t> first_at;
  std::vector<bool> used(mesh.NumVertices(), false);
  std::vector<bool> in_real_face(mesh.NumVertices(), false);
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    for (const uint32_t v : mesh.Face(f)) {
      used[v] = true;
      if (HasThreePlaces(mesh, f)) in_real_face[v] = true;
    }
  }
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    first_at.try_emplace(PlaceOf(mesh.positions[v]), v);
  }
  std::vector<uint32_t> labels;
  for (uint32_t p = 0; p < decoded.positions.rows(); ++p) {
    ASSERT_TRUE(first_at.contains(PlaceOf(decoded, p)));
    labels.push_back(first_at.at(PlaceOf(decoded, p)));
    const auto vertex = order.FileVertices({&p, 1});
    ASSERT_TRUE(vertex.ok());
    ASSERT_EQ(PlaceOf(mesh.positions[vertex->at(0)]), PlaceOf(decoded, p));
  }
  const auto in_file_order = order.VertexLabelsInFileOrder(labels);
  ASSERT_TRUE(in_file_order.ok()) << in_file_order.status();
  for (uint32_t v = 0; v < mesh.NumVertices(); ++v) {
    const uint32_t label = (*in_file_order)[v];
    ASSERT_EQ(label == client::kNone, !used[v]) << "vertex " << v;
    if (in_real_face[v]) {
      ASSERT_EQ(label, first_at.at(PlaceOf(mesh.positions[v])));
    }
  }
}

enum class Shape {
  kTriangles,
  kPolygons,
  kNonManifold,
  kDuplicates,
  kDegenerate,
  kIsolated,
  kApart
};
enum class Seams { kNone, kUv, kNormal, kBoth };

PolygonMesh MakeMesh(Shape shape, Seams seams) {
  PolygonMesh mesh;
  switch (shape) {
    case Shape::kTriangles:
      mesh = Torus(false);
      break;
    case Shape::kPolygons:
      mesh = Polygons();
      break;
    case Shape::kNonManifold:
      mesh = NonManifold();
      break;
    case Shape::kDuplicates:
      mesh = Duplicates();
      break;
    case Shape::kDegenerate:
      mesh = Degenerate();
      break;
    case Shape::kIsolated:
      mesh = Isolated();
      break;
    case Shape::kApart:
      mesh = Apart();
      break;
  }
  if (seams == Seams::kUv || seams == Seams::kBoth) AddUvSeam(&mesh);
  if (seams == Seams::kNormal || seams == Seams::kBoth) AddNormalSeams(&mesh);
  return mesh;
}

class OrderTest
    : public ::testing::TestWithParam<std::tuple<EncodeMethod, Shape, Seams>> {
};

TEST_P(OrderTest, EveryFaceAndVertexComesBackAtEverySpeed) {
  const auto [method, shape, seams] = GetParam();
  const PolygonMesh mesh = MakeMesh(shape, seams);
  for (int speed = 0; speed <= 10; ++speed) {
    SCOPED_TRACE(speed);
    const auto encoded = EncodeMesh(
        mesh, {.method = method, .speed = speed, .keep_attributes = true});
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    if (method != EncodeMethod::kAuto) {
      EXPECT_EQ(encoded->method, method);
    }
    const auto decoded = DecodeDraco(encoded->bytes, MeshLimits());
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    ASSERT_EQ(decoded->faces.size(), encoded->order.NumDecodedFaces());
    ASSERT_EQ(decoded->positions.rows(), encoded->order.NumDecodedPoints());
    ExpectFacesComeBack(mesh, *decoded, encoded->order);
    ExpectVerticesComeBack(mesh, *decoded, encoded->order);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, OrderTest,
    ::testing::Combine(::testing::Values(EncodeMethod::kAuto,
                                         EncodeMethod::kEdgebreaker,
                                         EncodeMethod::kSequential),
                       ::testing::Values(Shape::kTriangles, Shape::kPolygons,
                                         Shape::kNonManifold,
                                         Shape::kDuplicates, Shape::kDegenerate,
                                         Shape::kIsolated, Shape::kApart),
                       ::testing::Values(Seams::kNone, Seams::kUv,
                                         Seams::kNormal, Seams::kBoth)));

// Without which the tests above would prove nothing.
TEST(EncodeMeshTest, EdgebreakerDoesChangeTheOrder) {
  const PolygonMesh mesh = Torus(false);
  const auto encoded = EncodeMesh(mesh, {.method = EncodeMethod::kEdgebreaker});
  ASSERT_TRUE(encoded.ok());
  std::vector<uint32_t> numbers(encoded->order.NumDecodedFaces());
  for (uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  EXPECT_NE(*encoded->order.FaceLabelsInFileOrder(numbers), numbers);
}

TEST(EncodeMeshTest, AutoTakesEdgebreakerWhereItKeepsEverything) {
  const auto method = [](const PolygonMesh& mesh) {
    const auto encoded = EncodeMesh(mesh, {});
    EXPECT_TRUE(encoded.ok()) << encoded.status();
    return encoded->method;
  };
  EXPECT_EQ(method(Torus(false)), EncodeMethod::kEdgebreaker);
  EXPECT_EQ(method(NonManifold()), EncodeMethod::kEdgebreaker);
  EXPECT_EQ(method(Degenerate()), EncodeMethod::kSequential);
  EXPECT_EQ(method(Isolated()), EncodeMethod::kEdgebreaker);
}

TEST(EncodeMeshTest, AHugeFanIsEncodedQuickly) {
  PolygonMesh mesh;
  constexpr uint32_t kBlades = 200'000;
  mesh.positions.push_back({0, 0, 1});
  for (uint32_t i = 0; i < kBlades; ++i) {
    const double angle = 2 * M_PI * i / kBlades;
    mesh.positions.push_back({static_cast<float>(std::cos(angle)),
                              static_cast<float>(std::sin(angle)), 0});
    mesh.AddFace(Corners3{0, 1 + i, 1 + (i + 1) % kBlades});
  }
  const auto start = std::chrono::steady_clock::now();
  const auto encoded = EncodeMesh(mesh, {});
  const std::chrono::duration<double> seconds =
      std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(encoded.ok());
  EXPECT_EQ(encoded->method, EncodeMethod::kSequential);
  EXPECT_LT(seconds.count(), 10);
}

// The numbers that tell the order stay at home.
TEST(EncodeMeshTest, SendsPositionsAlone) {
  for (const EncodeMethod method :
       {EncodeMethod::kEdgebreaker, EncodeMethod::kSequential}) {
    for (int speed = 0; speed <= 10; ++speed) {
      for (const PolygonMesh& mesh : {Torus(false), Polygons(), NonManifold(),
                                      Duplicates(), Degenerate(), Isolated()}) {
        const auto encoded =
            EncodeMesh(mesh, {.method = method, .speed = speed});
        ASSERT_TRUE(encoded.ok()) << encoded.status();
        draco::DecoderBuffer buffer;
        buffer.Init(encoded->bytes.data(), encoded->bytes.size());
        const auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        ASSERT_TRUE(decoded.ok());
        EXPECT_EQ(decoded.value()->num_attributes(), 1) << speed;
      }
    }
  }
}

// Wherever they are, they change nothing of what is sent.
TEST(EncodeMeshTest, LeavesOutUnusedVertices) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const PolygonMesh torus = Torus(false);
  PolygonMesh mesh = torus;
  for (const double x : {0.1, 1e300, kInfinity, -kInfinity, std::nan("")}) {
    mesh.positions.push_back({x, 0, 0});
    mesh.positions.push_back({x, 0, 0});
  }
  mesh.positions.push_back(mesh.positions[0]);
  for (const int bits : {0, 10}) {
    const EncodeOptions options{.quantization_bits = bits};
    const auto encoded = EncodeMesh(mesh, options);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_EQ(encoded->bytes, EncodeMesh(torus, options)->bytes);
    EXPECT_EQ(encoded->order.NumUnusedVertices(), 11u);
  }
}

TEST(EncodeMeshTest, LeavesOutMoreUnusedVerticesThanDracoHolds) {
  PolygonMesh mesh;
  for (int i = 0; i < 20; ++i) {
    mesh.positions.push_back(
        {static_cast<float>(i), static_cast<float>(i * i), 0});
  }
  mesh.AddFace(Corners3{17, 3, 9});
  for (const EncodeMethod method :
       {EncodeMethod::kAuto, EncodeMethod::kEdgebreaker,
        EncodeMethod::kSequential}) {
    const auto encoded = EncodeMesh(mesh, {.method = method});
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    const auto decoded = DecodeDraco(encoded->bytes, MeshLimits());
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    ExpectFacesComeBack(mesh, *decoded, encoded->order);
    ExpectVerticesComeBack(mesh, *decoded, encoded->order);
  }
}

TEST(EncodeMeshTest, SendsNoAttributesUnlessAsked) {
  PolygonMesh mesh = Torus(false);
  const std::string plain = EncodeMesh(mesh, {})->bytes;
  AddUvSeam(&mesh);
  AddNormalSeams(&mesh);
  EXPECT_EQ(EncodeMesh(mesh, {})->bytes, plain);
  EXPECT_GT(EncodeMesh(mesh, {.keep_attributes = true})->bytes.size(),
            plain.size());
}

TEST(EncodeMeshTest, EqualMeshesGiveEqualBytes) {
  for (const EncodeMethod method :
       {EncodeMethod::kEdgebreaker, EncodeMethod::kSequential}) {
    const std::string first =
        EncodeMesh(NonManifold(), {.method = method})->bytes;
    EXPECT_EQ(EncodeMesh(NonManifold(), {.method = method})->bytes, first);
  }
}

// Quantized positions are moved, so each face is looked for where it was, give
// or take; the faces of the torus are much further apart than that.
TEST(EncodeMeshTest, FacesComeBackFromQuantizedMeshes) {
  const PolygonMesh mesh = Torus(false);
  for (const EncodeMethod method :
       {EncodeMethod::kEdgebreaker, EncodeMethod::kSequential}) {
    const auto encoded =
        EncodeMesh(mesh, {.method = method, .quantization_bits = 12});
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_LT(encoded->bytes.size(),
              EncodeMesh(mesh, {.method = method})->bytes.size());
    const auto decoded = DecodeDraco(encoded->bytes, MeshLimits());
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    const auto centre = [&](size_t f) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const uint32_t v : mesh.Face(f)) {
        sum += Eigen::RowVector3d(mesh.positions[v].data());
      }
      return Eigen::RowVector3d(sum / 3);
    };
    std::vector<uint32_t> labels;
    for (const Triangle& face : decoded->faces) {
      const Eigen::RowVector3d where =
          (decoded->positions.row(face[0]) + decoded->positions.row(face[1]) +
           decoded->positions.row(face[2])) /
          3;
      uint32_t best = 0;
      for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
        if ((centre(f) - where).norm() < (centre(best) - where).norm()) {
          best = f;
        }
      }
      EXPECT_LT((centre(best) - where).norm(), 0.01);
      labels.push_back(best);
    }
    const auto in_file_order = encoded->order.FaceLabelsInFileOrder(labels);
    for (uint32_t f = 0; f < mesh.NumFaces(); ++f) {
      ASSERT_EQ((*in_file_order)[f], f);
    }
  }
}

TEST(EncodeMeshTest, SendsNumbersThatAreNotFiniteAsTheyAre) {
  PolygonMesh mesh = Torus(false);
  mesh.positions[3][1] = std::numeric_limits<float>::quiet_NaN();
  mesh.positions[7][0] = std::numeric_limits<float>::infinity();
  for (const int bits : {0, 10}) {
    const auto encoded = EncodeMesh(mesh, {.quantization_bits = bits});
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_EQ(encoded->order.NumDecodedFaces(), mesh.NumFaces());
    EXPECT_FALSE(DecodeDraco(encoded->bytes, MeshLimits()).ok());
  }
}

// A torus ten million of its radii away, its smallest part a millionth of it.
TEST(EncodeMeshTest, DoublesComeBackToTheBit) {
  PolygonMesh mesh = Torus(false);
  for (auto& position : mesh.positions) position[1] += 1e7 + 1e-9;
  mesh.positions[11][0] = 1e300;
  mesh.positions[12][2] = 1e-300;
  for (const EncodeMethod method :
       {EncodeMethod::kEdgebreaker, EncodeMethod::kSequential}) {
    const auto encoded = EncodeMesh(mesh, {.method = method});
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_EQ(encoded->method, method);
    const auto decoded = DecodeDraco(encoded->bytes, MeshLimits());
    ASSERT_TRUE(decoded.ok()) << decoded.status();
    ExpectFacesComeBack(mesh, *decoded, encoded->order);
    ExpectVerticesComeBack(mesh, *decoded, encoded->order);
  }
}

TEST(EncodeMeshTest, SendsFloatsUnlessThereIsADouble) {
  PolygonMesh mesh = Torus(false);
  const auto size = [&mesh](int bits) {
    return EncodeMesh(mesh, {.method = EncodeMethod::kSequential,
                             .quantization_bits = bits})
        ->bytes.size();
  };
  const size_t floats = size(0), quantized = size(12);
  mesh.positions[4][2] = 0.1;
  EXPECT_EQ(size(0), floats + 12 * mesh.NumVertices());
  EXPECT_NEAR(size(12), quantized, 8);
}

TEST(EncodeMeshTest, PutsTheCornersOfASoupTogether) {
  const PolygonMesh torus = Torus(false);
  PolygonMesh soup;
  for (size_t f = 0; f < torus.NumFaces(); ++f) {
    const uint32_t first = static_cast<uint32_t>(soup.NumVertices());
    for (const uint32_t v : torus.Face(f)) {
      soup.positions.push_back(torus.positions[v]);
    }
    soup.AddFace(Corners3{first, first + 1, first + 2});
  }
  const auto encoded = EncodeMesh(soup, {});
  ASSERT_TRUE(encoded.ok());
  EXPECT_EQ(encoded->order.NumDecodedPoints(), torus.NumVertices());
}

TEST(EncodeMeshTest, ErrorsSayWhatToDo) {
  const auto message = [](const PolygonMesh& mesh,
                          const EncodeOptions& options) {
    const absl::Status status = EncodeMesh(mesh, options).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    return std::string(status.message());
  };
  PolygonMesh edges;
  edges.positions.resize(2);
  edges.AddFace(std::array<uint32_t, 2>{0, 1});
  EXPECT_THAT(message(PolygonMesh(), {}), HasSubstr("no face"));
  EXPECT_THAT(message(edges, {}), HasSubstr("three corners"));
  EXPECT_THAT(message(Torus(false), {.speed = 11}), HasSubstr("0 to 10"));
  EXPECT_THAT(
      message(Torus(false), {.quantization_bits = kMaxQuantizationBits + 1}),
      HasSubstr("1 to 24"));
  PolygonMesh point;
  point.positions.resize(1);
  point.AddFace(Corners3{0, 0, 0});
  EXPECT_THAT(message(point, {.method = EncodeMethod::kEdgebreaker}),
              HasSubstr("sequential"));
  EXPECT_TRUE(EncodeMesh(point, {}).ok());
}

}  // namespace
}  // namespace marrow
