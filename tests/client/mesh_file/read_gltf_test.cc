#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <string>

#include "tests/client/mesh_file/matchers.h"

namespace marrow {
namespace {

using ::testing::ElementsAre;

template <typename T>
void Append(std::initializer_list<T> values, std::string* out) {
  for (const T value : values) {
    out->append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
}

void Pad(char fill, std::string* out) {
  while (out->size() % 4 != 0) out->push_back(fill);
}

std::string Glb(std::string json, std::string binary) {
  Pad(' ', &json);
  Pad('\0', &binary);
  const auto size = [](size_t n) { return static_cast<uint32_t>(n); };
  std::string out = "glTF";
  Append<uint32_t>({2, size(28 + json.size() + binary.size())}, &out);
  Append<uint32_t>({size(json.size())}, &out);
  out += "JSON" + json;
  Append<uint32_t>({size(binary.size())}, &out);
  out += std::string("BIN\0", 4) + binary;
  return out;
}

// Bytes 0..48: four points. 48..54: indices 0 1 2 as 16 bits. 56..72: indices
// 0 1 2 3 as 32 bits.
std::string Binary() {
  std::string out;
  Append<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, &out);
  Append<uint16_t>({0, 1, 2, 0}, &out);
  Append<uint32_t>({0, 1, 2, 3}, &out);
  return out;
}

// `scene` is what comes before the accessors: nodes, meshes and scenes.
std::string Model(const std::string& scene) {
  return Glb("{\"asset\":{\"version\":\"2.0\"}," + scene +
                 ",\"accessors\":["
                 "{\"bufferView\":0,\"componentType\":5126,\"count\":4,"
                 "\"type\":\"VEC3\"},"
                 "{\"bufferView\":1,\"componentType\":5123,\"count\":3,"
                 "\"type\":\"SCALAR\"},"
                 "{\"bufferView\":2,\"componentType\":5125,\"count\":4,"
                 "\"type\":\"SCALAR\"},"
                 "{\"bufferView\":2,\"componentType\":5125,\"count\":400,"
                 "\"type\":\"SCALAR\"},"
                 "{\"bufferView\":0,\"componentType\":5126,\"count\":2,"
                 "\"type\":\"VEC3\"}],"
                 "\"bufferViews\":["
                 "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
                 "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":6},"
                 "{\"buffer\":0,\"byteOffset\":56,\"byteLength\":16}],"
                 "\"buffers\":[{\"byteLength\":72}]}",
             Binary());
}

std::string Primitive(const std::string& rest) {
  return "{\"attributes\":{\"POSITION\":0}" + rest + "}";
}

constexpr char kOneNode[] =
    "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],";

std::string OneMesh(const std::string& primitive) {
  return Model(std::string(kOneNode) + "\"meshes\":[{\"primitives\":[" +
               primitive + "]}]");
}

TEST(ReadGltfTest, ReadsTrianglesStripsAndFans) {
  EXPECT_THAT(Faces(ParseOrFail("m.glb", OneMesh(Primitive(",\"indices\":1")))),
              ElementsAre(ElementsAre(0, 1, 2)));
  EXPECT_THAT(Faces(ParseOrFail(
                  "m.glb", OneMesh(Primitive(",\"indices\":2,\"mode\":5")))),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(1, 3, 2)));
  EXPECT_THAT(Faces(ParseOrFail("m.glb", OneMesh(Primitive(",\"mode\":6")))),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 2, 3)));
}

TEST(ReadGltfTest, WalksNodesPrimitivesAndIndicesInOrder) {
  // The scene's roots are 2 and 0; 1 hangs below 2. Mesh 1 has two primitives
  // with faces and one of lines.
  const PolygonMesh mesh = ParseOrFail(
      "m.glb",
      Model("\"scene\":0,\"scenes\":[{\"nodes\":[2,0]}],\"nodes\":["
            "{\"mesh\":0,\"translation\":[0,0,7]},"
            "{\"mesh\":0,\"translation\":[1,0,0],\"scale\":[-1,1,1]},"
            "{\"mesh\":1,\"children\":[1],\"translation\":[10,0,0]}],"
            "\"meshes\":[{\"primitives\":[" +
            Primitive(",\"indices\":1") + "]},{\"primitives\":[" +
            Primitive(",\"indices\":1") + "," + Primitive(",\"mode\":1") + "," +
            Primitive(",\"indices\":2,\"mode\":5") + "]}]"));
  EXPECT_THAT(Faces(mesh),
              ElementsAre(ElementsAre(0, 1, 2),       // node 2
                          ElementsAre(4, 5, 6),       //
                          ElementsAre(5, 7, 6),       //
                          ElementsAre(8, 10, 9),      // node 1, mirrored
                          ElementsAre(12, 13, 14)));  // node 0
  EXPECT_THAT(mesh.positions[1], ElementsAre(11, 0, 0));
  EXPECT_THAT(mesh.positions[9], ElementsAre(10, 0, 0));  // 10 + 1 - 1
  EXPECT_THAT(mesh.positions[12], ElementsAre(0, 0, 7));
}

TEST(ReadGltfTest, AppliesMatricesAndRotations) {
  const PolygonMesh mesh = ParseOrFail(
      "m.glb", Model("\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
                     "{\"children\":[1],"
                     "\"matrix\":[2,0,0,0, 0,2,0,0, 0,0,2,0, 5,6,7,1]},"
                     "{\"mesh\":0,\"rotation\":[0,0,1,0]}],"
                     "\"meshes\":[{\"primitives\":[" +
                     Primitive(",\"indices\":1") + "]}]"));
  EXPECT_THAT(mesh.positions[1], ElementsAre(3, 6, 7));  // half a turn about z
}

TEST(ReadGltfTest, ErrorsNameTheElementOfAPrimitive) {
  ExpectRefused("m.glb", OneMesh(Primitive(",\"indices\":3")),
                {"mesh 0, primitive 0", "accessor 3", "beyond its buffer"});
  ExpectRefused("m.glb", OneMesh("{\"attributes\":{\"POSITION\":9}}"),
                {"accessor 9 does not exist"});
  ExpectRefused("m.glb",
                OneMesh("{\"attributes\":{\"POSITION\":4},\"indices\":1}"),
                {"index 2", "vertex index 2 is out of range", "2 vertices"});
  ExpectRefused("m.glb", OneMesh("{\"attributes\":{\"POSITION\":1}}"),
                {"POSITION"});
  ExpectRefused("m.glb", OneMesh("{\"attributes\":{\"NORMAL\":0}}"),
                {"no attribute POSITION"});
  ExpectRefused("m.glb", OneMesh(Primitive(",\"mode\":1")), {"no faces"});
}

TEST(ReadGltfTest, ErrorsNameTheNode) {
  const std::string mesh =
      "\"meshes\":[{\"primitives\":[" + Primitive("") + "]}]";
  ExpectRefused("m.glb",
                Model("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,"
                      "\"children\":[0]}]," +
                      mesh),
                {"node 0", "two parents"});
  ExpectRefused(
      "m.glb",
      Model("\"scenes\":[{\"nodes\":[5]}],\"nodes\":[{\"mesh\":0}]," + mesh),
      {"node 5 is out of range"});
  ExpectRefused("m.glb",
                Model("\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]"
                      ",\"nodes\":[{\"mesh\":0}]," +
                      mesh),
                {"KHR_draco_mesh_compression", "export it without"});
  ExpectRefused("m.gltf", "{\"asset\":", {"glTF"});
  ExpectRefused("m.glb", "glTF", {"glTF"});
}

TEST(ReadGltfTest, ReadsAModelWithoutScenes) {
  const PolygonMesh mesh = ParseOrFail(
      "m.glb", Model("\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[" +
                     Primitive(",\"indices\":1") + "]}]"));
  EXPECT_EQ(mesh.NumFaces(), 1u);
}

TEST(ReadGltfTest, ReadsBuffersBesideTheFile) {
  const std::string folder = ::testing::TempDir();
  std::ofstream(folder + "/read_gltf_test.bin", std::ios::binary) << Binary();
  const std::string json =
      "{\"asset\":{\"version\":\"2.0\"}," + std::string(kOneNode) +
      "\"meshes\":[{\"primitives\":[" + Primitive("") +
      "]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
      "\"count\":3,\"type\":\"VEC3\"}],"
      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
      "\"buffers\":[{\"byteLength\":72,\"uri\":\"read_gltf_test.bin\"}]}";
  EXPECT_EQ(ParseOrFail(folder + "/m.gltf", json).NumVertices(), 3u);
}

TEST(ReadGltfTest, SurvivesDamage) {
  ExpectSurvivesDamage("m.glb", OneMesh(Primitive(",\"indices\":1")));
}

}  // namespace
}  // namespace marrow
