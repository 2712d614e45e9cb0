#include <tiny_gltf.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/mesh_file/readers.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// A small file can show one mesh at many nodes; this bounds the sum.
constexpr size_t kMaxVertices = size_t{1} << 26;
constexpr size_t kMaxCorners = 3 * kMaxVertices;

// Pictures are of no interest, and may be missing or broken.
bool SkipImage(tinygltf::Image*, int, std::string*, std::string*, int, int,
               const unsigned char*, int, void*) {
  return true;
}

// An accessor whose every element lies within its buffer.
struct AccessorView {
  const unsigned char* data = nullptr;
  size_t count = 0;
  size_t stride = 0;
  int component_type = 0;
  bool normalized = false;
};

template <typename T>
T Load(const unsigned char* data) {
  T value;
  std::memcpy(&value, data, sizeof(value));
  return value;
}

// A normalized integer stands for -1..1 or 0..1.
template <typename T>
float LoadScaled(const unsigned char* data, bool normalized) {
  const float value = static_cast<float>(Load<T>(data));
  if (!normalized) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<T>::max()),
                  -1.0f);
}

float LoadCoordinate(const AccessorView& view, size_t element, int axis) {
  const int size = tinygltf::GetComponentSizeInBytes(view.component_type);
  const unsigned char* data =
      view.data + element * view.stride + ptrdiff_t{axis} * size;
  switch (view.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return LoadScaled<int8_t>(data, view.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return LoadScaled<uint8_t>(data, view.normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return LoadScaled<int16_t>(data, view.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return LoadScaled<uint16_t>(data, view.normalized);
    default:
      return Load<float>(data);
  }
}

uint32_t LoadIndex(const AccessorView& view, size_t element) {
  const unsigned char* data = view.data + element * view.stride;
  switch (view.component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return Load<uint8_t>(data);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return Load<uint16_t>(data);
    default:
      return Load<uint32_t>(data);
  }
}

bool IsCoordinateType(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ||
         (component_type >= TINYGLTF_COMPONENT_TYPE_BYTE &&
          component_type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

bool IsIndexType(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

Eigen::Affine3d LocalTransform(const tinygltf::Node& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (node.matrix.size() == 16) {
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    return transform;
  }
  if (node.translation.size() == 3) {
    transform.translate(
        Eigen::Map<const Eigen::Vector3d>(node.translation.data()));
  }
  if (node.rotation.size() == 4) {
    const std::vector<double>& q = node.rotation;  // x y z w
    transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]));
  }
  if (node.scale.size() == 3) {
    transform.scale(Eigen::Map<const Eigen::Vector3d>(node.scale.data()));
  }
  return transform;
}

class GltfReader {
 public:
  explicit GltfReader(const std::string& path) : path_(path) {}

  absl::StatusOr<PolygonMesh> Read(std::string_view bytes);

 private:
  struct Visit {
    int node;
    Eigen::Affine3d parent;
  };

  absl::Status Parse(std::string_view bytes);
  absl::Status CheckExtensions() const;
  std::vector<int> Roots() const;
  absl::Status WalkNodes();
  absl::Status ReadMesh(int mesh, const Eigen::Affine3d& transform);
  absl::Status ReadPrimitive(const tinygltf::Primitive& primitive,
                             const std::string& where,
                             const Eigen::Affine3d& transform);
  absl::StatusOr<AccessorView> View(int accessor,
                                    const std::string& where) const;
  void AddPositions(const AccessorView& view, const Eigen::Affine3d& transform);
  absl::StatusOr<std::vector<uint32_t>> ReadIndices(
      const tinygltf::Primitive& primitive, const std::string& where,
      size_t num_vertices) const;
  void AddTriangles(int mode, const std::vector<uint32_t>& indices, bool flip);
  absl::Status Error(const std::string& message) const {
    return absl::InvalidArgumentError(absl::StrCat(path_, ": ", message));
  }

  const std::string path_;
  tinygltf::Model model_;
  PolygonMesh mesh_;
};

absl::Status GltfReader::Parse(std::string_view bytes) {
  if (bytes.size() > std::numeric_limits<uint32_t>::max()) {
    return Error("is larger than a glTF file can be (4 GiB)");
  }
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(&SkipImage, nullptr);
  std::string error;
  std::string warning;
  const std::string folder =
      std::filesystem::path(path_).parent_path().string();
  const uint32_t size = static_cast<uint32_t>(bytes.size());
  const bool binary = bytes.substr(0, 4) == "glTF";
  const bool ok =
      binary ? loader.LoadBinaryFromMemory(
                   &model_, &error, &warning,
                   reinterpret_cast<const unsigned char*>(bytes.data()), size,
                   folder)
             : loader.LoadASCIIFromString(&model_, &error, &warning,
                                          bytes.data(), size, folder);
  if (ok) return absl::OkStatus();
  // The library's message may run over several lines.
  const std::string reason =
      absl::StrReplaceAll(error.substr(0, 300), {{"\n", " "}});
  return Error(absl::StrCat("is not a whole glTF file: ", reason));
}

absl::Status GltfReader::CheckExtensions() const {
  for (const std::string& extension : model_.extensionsRequired) {
    if (extension == "KHR_draco_mesh_compression" ||
        extension == "EXT_meshopt_compression") {
      return Error(absl::StrCat("uses ", extension,
                                ", which is not supported; export it without "
                                "mesh compression"));
    }
  }
  return absl::OkStatus();
}

std::vector<int> GltfReader::Roots() const {
  if (!model_.scenes.empty()) {
    const size_t scene = model_.defaultScene < 0 ? 0 : model_.defaultScene;
    return model_.scenes[std::min(scene, model_.scenes.size() - 1)].nodes;
  }
  std::vector<bool> is_child(model_.nodes.size(), false);
  for (const tinygltf::Node& node : model_.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<size_t>(child) < is_child.size()) {
        is_child[child] = true;
      }
    }
  }
  std::vector<int> roots;
  for (size_t n = 0; n < is_child.size(); ++n) {
    if (!is_child[n]) roots.push_back(static_cast<int>(n));
  }
  return roots;
}

// Depth first, without recursion: a file may nest its nodes as deep as it
// likes. A node that is met twice is an error, so that loops end and shared
// children do not multiply.
absl::Status GltfReader::WalkNodes() {
  std::vector<bool> visited(model_.nodes.size(), false);
  std::vector<Visit> stack;
  const auto push = [&stack](const std::vector<int>& nodes,
                             const Eigen::Affine3d& parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      stack.push_back({*node, parent});
    }
  };
  push(Roots(), Eigen::Affine3d::Identity());
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (visit.node < 0 ||
        static_cast<size_t>(visit.node) >= model_.nodes.size()) {
      return Error(absl::StrCat("node ", visit.node, " is out of range (",
                                model_.nodes.size(), " nodes)"));
    }
    if (visited[visit.node]) {
      return Error(absl::StrCat("node ", visit.node,
                                " has two parents; glTF nodes form a tree"));
    }
    visited[visit.node] = true;
    const tinygltf::Node& node = model_.nodes[visit.node];
    const Eigen::Affine3d transform = visit.parent * LocalTransform(node);
    // A skinned mesh stands where its joints put it, not its node.
    if (node.mesh >= 0) {
      MARROW_RETURN_IF_ERROR(ReadMesh(
          node.mesh, node.skin >= 0 ? Eigen::Affine3d::Identity() : transform));
    }
    push(node.children, transform);
  }
  return absl::OkStatus();
}

absl::Status GltfReader::ReadMesh(int mesh, const Eigen::Affine3d& transform) {
  if (static_cast<size_t>(mesh) >= model_.meshes.size()) {
    return Error(absl::StrCat("mesh ", mesh, " is out of range (",
                              model_.meshes.size(), " meshes)"));
  }
  const std::vector<tinygltf::Primitive>& primitives =
      model_.meshes[mesh].primitives;
  for (size_t p = 0; p < primitives.size(); ++p) {
    MARROW_RETURN_IF_ERROR(ReadPrimitive(
        primitives[p], absl::StrCat("mesh ", mesh, ", primitive ", p),
        transform));
  }
  return absl::OkStatus();
}

absl::StatusOr<AccessorView> GltfReader::View(int accessor,
                                              const std::string& where) const {
  const std::string name = absl::StrCat(where, ": accessor ", accessor);
  if (accessor < 0 ||
      static_cast<size_t>(accessor) >= model_.accessors.size()) {
    return Error(absl::StrCat(name, " does not exist"));
  }
  const tinygltf::Accessor& source = model_.accessors[accessor];
  if (source.sparse.isSparse) {
    return Error(absl::StrCat(name, " is sparse, which is not supported"));
  }
  if (source.bufferView < 0 ||
      static_cast<size_t>(source.bufferView) >= model_.bufferViews.size()) {
    return Error(absl::StrCat(
        name, " has no data; if the mesh is compressed, export it without"));
  }
  const tinygltf::BufferView& window = model_.bufferViews[source.bufferView];
  if (window.buffer < 0 ||
      static_cast<size_t>(window.buffer) >= model_.buffers.size()) {
    return Error(absl::StrCat(name, " has no buffer"));
  }
  const std::vector<unsigned char>& data = model_.buffers[window.buffer].data;
  const int stride = source.ByteStride(window);
  const int element = tinygltf::GetComponentSizeInBytes(source.componentType) *
                      tinygltf::GetNumComponentsInType(source.type);
  if (stride <= 0 || element <= 0) {
    return Error(absl::StrCat(name, " has an unknown type or stride"));
  }
  // Each bound is checked before the next sum, so that none can overflow.
  const bool window_fits = window.byteOffset <= data.size() &&
                           window.byteLength <= data.size() - window.byteOffset;
  const bool begins_inside =
      window_fits && source.byteOffset <= window.byteLength;
  const size_t room = begins_inside ? window.byteLength - source.byteOffset : 0;
  const size_t last = source.count == 0 ? 0 : source.count - 1;
  if (!begins_inside ||
      (source.count > 0 && (room < static_cast<size_t>(element) ||
                            last > (room - element) / stride))) {
    return Error(absl::StrCat(name, " reaches beyond its buffer"));
  }
  return AccessorView{data.data() + window.byteOffset + source.byteOffset,
                      source.count, static_cast<size_t>(stride),
                      source.componentType, source.normalized};
}

void GltfReader::AddPositions(const AccessorView& view,
                              const Eigen::Affine3d& transform) {
  // Untouched where nothing moves, to the bit.
  const bool moves = transform.matrix() != Eigen::Matrix4d::Identity();
  for (size_t i = 0; i < view.count; ++i) {
    Eigen::Vector3f point(LoadCoordinate(view, i, 0),
                          LoadCoordinate(view, i, 1),
                          LoadCoordinate(view, i, 2));
    if (moves) point = (transform * point.cast<double>()).cast<float>();
    mesh_.positions.push_back({point.x(), point.y(), point.z()});
  }
}

absl::StatusOr<std::vector<uint32_t>> GltfReader::ReadIndices(
    const tinygltf::Primitive& primitive, const std::string& where,
    size_t num_vertices) const {
  std::vector<uint32_t> indices;
  if (primitive.indices < 0) {
    for (uint32_t i = 0; i < num_vertices; ++i) indices.push_back(i);
    return indices;
  }
  MARROW_ASSIGN_OR_RETURN(const AccessorView view,
                          View(primitive.indices, where));
  if (!IsIndexType(view.component_type) ||
      model_.accessors[primitive.indices].type != TINYGLTF_TYPE_SCALAR) {
    return Error(absl::StrCat(where, ": the indices are not unsigned scalars"));
  }
  if (view.count > kMaxCorners) {
    return Error(absl::StrCat(where, ": too many indices: ", view.count));
  }
  indices.resize(view.count);
  for (size_t i = 0; i < view.count; ++i) {
    indices[i] = LoadIndex(view, i);
    if (indices[i] >= num_vertices) {
      return Error(absl::StrCat(where, ": index ", i, ": vertex index ",
                                indices[i],
                                " is out of range (the primitive "
                                "has ",
                                num_vertices, " vertices)"));
    }
  }
  return indices;
}

// A mirroring transform turns faces inside out, so they are flipped back.
void GltfReader::AddTriangles(int mode, const std::vector<uint32_t>& indices,
                              bool flip) {
  const auto add = [this, flip](uint32_t a, uint32_t b, uint32_t c) {
    mesh_.AddFace(flip ? std::array<uint32_t, 3>{a, c, b}
                       : std::array<uint32_t, 3>{a, b, c});
  };
  const size_t count = indices.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (size_t i = 0; i + 2 < count; i += 3) {
      add(indices[i], indices[i + 1], indices[i + 2]);
    }
    return;
  }
  const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
  for (size_t i = 0; i + 2 < count; ++i) {
    if (fan) {
      add(indices[0], indices[i + 1], indices[i + 2]);
    } else {
      const size_t odd = i % 2;
      add(indices[i], indices[i + 1 + odd], indices[i + 2 - odd]);
    }
  }
}

absl::Status GltfReader::ReadPrimitive(const tinygltf::Primitive& primitive,
                                       const std::string& where,
                                       const Eigen::Affine3d& transform) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    return absl::OkStatus();  // points and lines have no faces
  }
  if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    return Error(absl::StrCat(where, ": unknown mode ", primitive.mode));
  }
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    return Error(absl::StrCat(where, ": has no attribute POSITION"));
  }
  MARROW_ASSIGN_OR_RETURN(const AccessorView view,
                          View(position->second, where));
  if (!IsCoordinateType(view.component_type) ||
      model_.accessors[position->second].type != TINYGLTF_TYPE_VEC3) {
    return Error(absl::StrCat(where, ": POSITION is not three numbers"));
  }
  if (view.count > kMaxVertices - mesh_.NumVertices()) {
    return Error(absl::StrCat(where, ": over ", kMaxVertices, " vertices"));
  }
  MARROW_ASSIGN_OR_RETURN(std::vector<uint32_t> indices,
                          ReadIndices(primitive, where, view.count));
  if (3 * indices.size() > kMaxCorners - mesh_.face_vertices.size()) {
    return Error(absl::StrCat(where, ": over ", kMaxCorners, " corners"));
  }
  for (uint32_t& index : indices) {
    index += static_cast<uint32_t>(mesh_.NumVertices());
  }
  AddPositions(view, transform);
  AddTriangles(primitive.mode, indices, transform.linear().determinant() < 0);
  return absl::OkStatus();
}

absl::StatusOr<PolygonMesh> GltfReader::Read(std::string_view bytes) {
  try {
    MARROW_RETURN_IF_ERROR(Parse(bytes));
    MARROW_RETURN_IF_ERROR(CheckExtensions());
    MARROW_RETURN_IF_ERROR(WalkNodes());
  } catch (const std::exception& e) {
    return Error(absl::StrCat("cannot be read: ", e.what()));
  }
  return std::move(mesh_);
}

}  // namespace

absl::StatusOr<PolygonMesh> ReadGltf(const std::string& path,
                                     std::string_view bytes) {
  return GltfReader(path).Read(bytes);
}

}  // namespace marrow
