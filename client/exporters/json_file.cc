#include "client/exporters/json_file.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

namespace marrow {
namespace {

using client::Joint;
using client::kNone;
using client::Level;
using client::SegmentNode;
using Json = nlohmann::ordered_json;

Json IdOrNull(uint32_t id) { return id == kNone ? Json(nullptr) : Json(id); }

Json NodeJson(const SegmentNode& node) {
  return {{"id", node.id},
          {"parent", IdOrNull(node.parent)},
          {"children", node.children},
          {"level", node.level},
          {"area", node.area},
          {"centroid", node.centroid},
          {"medial_structure", node.medial_structure},
          {"salience", node.salience},
          {"iterations", node.iterations},
          {"stop_reason", node.stop_reason}};
}

Json SkeletonJson(const Level& level) {
  Json joints = Json::array();
  Json bones = Json::array();
  for (const Joint& joint : level.skeleton.joints) {
    joints.push_back({{"id", joint.id},
                      {"parent", IdOrNull(joint.parent)},
                      {"kind", joint.articulation ? "articulation" : "segment"},
                      {"position", joint.position},
                      {"segments", joint.segments}});
    if (joint.parent != kNone) {
      bones.push_back({{"from", joint.parent}, {"to", joint.id}});
    }
  }
  return {{"level", level.level}, {"joints", joints}, {"bones", bones}};
}

Json LevelJson(const Level& level) {
  std::map<uint32_t, uint64_t> face_counts;
  for (uint32_t label : level.face_labels) ++face_counts[label];
  Json segments = Json::array();
  for (const auto& [id, faces] : face_counts) {
    segments.push_back({{"id", id}, {"faces", faces}});
  }
  return {{"level", level.level}, {"segments", segments}};
}

std::string Compact(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Members on lines of their own for `depth` more levels of nesting, and all
// that is deeper on one line: a list of a thousand vertices stays a line.
void Write(const Json& value, int depth, const std::string& indent,
           std::string& out) {
  if (depth == 0 || !value.is_structured() || value.empty()) {
    out += Compact(value);
    return;
  }
  const std::string inner = indent + "  ";
  out += value.is_object() ? "{" : "[";
  const char* separator = "\n";
  for (auto it = value.begin(); it != value.end(); ++it) {
    out += separator + inner;
    if (value.is_object()) out += Compact(it.key()) + ": ";
    Write(*it, depth - 1, inner, out);
    separator = ",\n";
  }
  out += "\n" + indent + (value.is_object() ? "}" : "]");
}

}  // namespace

std::string JsonFile(std::string_view mesh_name, const PolygonMesh& mesh,
                     const client::Segmentation& segmentation) {
  Json nodes = Json::array();
  for (const SegmentNode& node : segmentation.nodes) {
    nodes.push_back(NodeJson(node));
  }
  Json levels = Json::array();
  Json skeletons = Json::array();
  for (const Level& level : segmentation.levels) {
    levels.push_back(LevelJson(level));
    skeletons.push_back(SkeletonJson(level));
  }
  const Json root = {
      {"schema", kJsonSchema},
      {"mesh",
       {{"name", mesh_name},
        {"vertices", mesh.NumVertices()},
        {"faces", mesh.NumFaces()}}},
      {"tree", {{"nodes", nodes}}},
      {"automatic_cut", {{"level", segmentation.AutomaticCut().level}}},
      {"levels", levels},
      {"skeletons", skeletons},
      {"report", segmentation.report},
      {"timings", segmentation.timings},
      {"cache", segmentation.cache}};
  constexpr int kNesting = 4;
  std::string text;
  Write(root, kNesting, "", text);
  return text + "\n";
}

}  // namespace marrow
