// The whole answer as JSON: tree, levels, skeletons and what was measured.
#ifndef MARROW_CLIENT_EXPORTERS_JSON_FILE_H_
#define MARROW_CLIENT_EXPORTERS_JSON_FILE_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "client/polygon_mesh.h"
#include "client/segmentation.h"

namespace marrow {

// The schema that JsonFile writes. docs/json.md describes every field.
inline constexpr std::string_view kJsonSchema = "marrow.segmentation/1";

// How the cut was asked for: text such as "segments:8", and ids of nodes.
struct CutNote {
  std::string text;
  std::vector<uint32_t> closed;
  std::vector<uint32_t> open;
};

// `mesh_name` is what the user calls the mesh, such as the file's name, and
// `files` are the names of what is written together, this file among them.
// Bytes that are not UTF-8, there or in the segmentation, become U+FFFD;
// numbers that are not finite become null. Finite numbers read back exactly.
// The order of the keys is fixed.
std::string JsonFile(std::string_view mesh_name, const PolygonMesh& mesh,
                     const client::Segmentation& segmentation,
                     const CutNote& asked = {},
                     const std::vector<std::string>& files = {});

// The schema that CutJsonFile writes.
inline constexpr std::string_view kCutJsonSchema = "marrow.cut/1";

// The same of a cut alone.
std::string CutJsonFile(std::string_view mesh_name, const PolygonMesh& mesh,
                        const client::CutAnswer& answer, const CutNote& asked,
                        const std::vector<std::string>& files = {});

}  // namespace marrow

#endif  // MARROW_CLIENT_EXPORTERS_JSON_FILE_H_
