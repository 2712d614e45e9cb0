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

std::map<uint32_t, uint64_t> CountFaces(const Level& level) {
  std::map<uint32_t, uint64_t> counts;
  for (uint32_t label : level.face_labels) ++counts[label];
  return counts;
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
  Json segments = Json::array();
  for (const auto& [id, faces] : CountFaces(level)) {
    segments.push_back({{"id", id}, {"faces", faces}});
  }
  return {{"level", level.level}, {"segments", segments}};
}

Json CutJson(const client::Cut& cut, const CutNote& asked) {
  std::map<uint32_t, uint64_t> face_counts = CountFaces(cut.level);
  Json segments = Json::array();
  for (const SegmentNode& segment : cut.segments) {
    // A polygon has one label: one that is cut through leaves some without.
    if (!face_counts.contains(segment.id)) continue;
    segments.push_back({{"id", segment.id},
                        {"faces", face_counts[segment.id]},
                        {"parent", IdOrNull(segment.parent)},
                        {"level", segment.level},
                        {"area", segment.area},
                        {"centroid", segment.centroid},
                        {"medial_structure", segment.medial_structure},
                        {"salience", segment.salience}});
  }
  Json skeleton = SkeletonJson(cut.level);
  skeleton.erase("level");
  return {{"spec", asked.text},       {"closed", asked.closed},
          {"open", asked.open},       {"number", segments.size()},
          {"salience", cut.salience}, {"segments", segments},
          {"skeleton", skeleton}};
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

std::string Format(const Json& root) {
  constexpr int kNesting = 4;
  std::string text;
  Write(root, kNesting, "", text);
  return text + "\n";
}

Json MeshJson(std::string_view name, const PolygonMesh& mesh) {
  return {{"name", name},
          {"vertices", mesh.NumVertices()},
          {"faces", mesh.NumFaces()}};
}

}  // namespace

std::string JsonFile(std::string_view mesh_name, const PolygonMesh& mesh,
                     const client::Segmentation& segmentation,
                     const CutNote& asked,
                     const std::vector<std::string>& files) {
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
      {"files", files},
      {"mesh", MeshJson(mesh_name, mesh)},
      {"tree", {{"nodes", nodes}}},
      {"automatic_cut", {{"level", segmentation.AutomaticLevel().level}}},
      {"cut", segmentation.cut.has_value() ? CutJson(*segmentation.cut, asked)
                                           : Json(nullptr)},
      {"levels", levels},
      {"skeletons", skeletons},
      {"report", segmentation.report},
      {"timings", segmentation.timings},
      {"cache", segmentation.cache}};
  return Format(root);
}

std::string CutJsonFile(std::string_view mesh_name, const PolygonMesh& mesh,
                        const client::CutAnswer& answer, const CutNote& asked,
                        const std::vector<std::string>& files) {
  return Format({{"schema", kCutJsonSchema},
                 {"files", files},
                 {"mesh", MeshJson(mesh_name, mesh)},
                 {"cut", CutJson(answer.cut, asked)},
                 {"timings", answer.timings},
                 {"cache", answer.cache}});
}

}  // namespace marrow
