// Posed creatures made in code: input for a first try, and ground truth.
//
// A sample is one smooth closed surface of genus 0 whose parts are known by
// construction. All poses of a sample at one number of faces share one list
// of faces, so face f is the same patch of skin in each, and differ only in
// where their vertices are.
#ifndef MARROW_CLIENT_SAMPLES_SAMPLES_H_
#define MARROW_CLIENT_SAMPLES_SAMPLES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/polygon_mesh.h"

namespace marrow {

inline constexpr uint32_t kMinSampleFaces = 5000;
inline constexpr uint32_t kMaxSampleFaces = 50000;
inline constexpr uint32_t kDefaultSampleFaces = 10000;

struct SampleInfo {
  std::string name;
  std::string description;         // one line, no full stop
  std::vector<std::string> poses;  // the first is "rest"
};

// In the order in which they are shown to people. Any thread may call.
const std::vector<SampleInfo>& ListSamples();

struct Sample {
  PolygonMesh mesh;  // triangles only, anticlockwise from outside; y is up
  std::vector<uint32_t> face_parts;     // a face; indexes part_names
  std::vector<std::string> part_names;  // 0 is the body, the others its limbs
};

// Makes a sample. An empty pose means "rest". A closed surface of triangles
// has an even number of faces: an odd `faces` gives one face less. The same
// arguments give the same bytes. Any thread may call.
//
// INVALID_ARGUMENT, naming what is valid, for an unknown name or pose, or for
// `faces` outside of kMinSampleFaces to kMaxSampleFaces.
absl::StatusOr<Sample> MakeSample(const std::string& name,
                                  const std::string& pose,
                                  uint32_t faces = kDefaultSampleFaces);

}  // namespace marrow

#endif  // MARROW_CLIENT_SAMPLES_SAMPLES_H_
