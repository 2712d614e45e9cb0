// Whether a text file has doubles.
#ifndef MARROW_CLIENT_MESH_FILE_TEXT_PRECISION_H_
#define MARROW_CLIENT_MESH_FILE_TEXT_PRECISION_H_

#include <string_view>

#include "client/mesh_file/text_scanner.h"
#include "client/polygon_mesh.h"

namespace marrow {

// Text does not say what its numbers were. They are floats where floats say as
// much as all the coordinates' digits do, and doubles otherwise: half of the
// file's digits would else be noise to whoever compresses them.
class TextPrecision {
 public:
  bool Parse(std::string_view token, double* coordinate) {
    if (!ParseDouble(token, coordinate)) return false;
    floats_ = floats_ && FloatSays(token, *coordinate);
    return true;
  }

  // Once all coordinates were parsed.
  void Apply(PolygonMesh* mesh) const {
    if (!floats_) return;
    for (auto& position : mesh->positions) {
      for (double& coordinate : position) coordinate = ToFloat(coordinate);
    }
  }

 private:
  bool floats_ = true;
};

}  // namespace marrow

#endif  // MARROW_CLIENT_MESH_FILE_TEXT_PRECISION_H_
