#include "tests/testing/creature_mesh.h"

#include "client/samples/samples.h"

namespace marrow {

CreatureMesh MakeCreature(const std::string& name) {
  const Sample sample = MakeSample(name, "", kMinSampleFaces).value();
  CreatureMesh creature;
  TriangleMesh& mesh = creature.mesh;
  mesh.positions.resize(sample.mesh.NumVertices(), 3);
  for (size_t v = 0; v < sample.mesh.NumVertices(); ++v)
    for (int i = 0; i < 3; ++i)
      mesh.positions(v, i) = sample.mesh.positions[v][i];
  for (size_t f = 0; f < sample.mesh.NumFaces(); ++f) {
    const auto face = sample.mesh.Face(f);
    mesh.faces.push_back({face[0], face[1], face[2]});
  }
  creature.parts = sample.face_parts;
  return creature;
}

}  // namespace marrow
