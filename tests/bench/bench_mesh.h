// The meshes that are measured: files, or samples where there are none,
// subdivided until they are large enough.
#ifndef MARROW_TESTS_BENCH_BENCH_MESH_H_
#define MARROW_TESTS_BENCH_BENCH_MESH_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "core/mesh/canonical_mesh.h"

namespace marrow {

struct BenchMesh {
  std::string name;  // such as "horse.off, 2 subdivisions"
  CanonicalMesh canonical;
};

// The sample `name` with about that many faces; above kMaxSampleFaces it is
// subdivided, every face into four.
absl::StatusOr<CanonicalMesh> MakeSampleMesh(const std::string& name,
                                             uint32_t faces);

// Of all files in `path` (a file, or a folder with those in its subfolders)
// the one that comes nearest to `vertices` after so many subdivisions; as it is
// where `vertices` is 0. Without a path, a sample. Errors: those of reading;
// NOT_FOUND where there is no mesh in the folder.
absl::StatusOr<BenchMesh> PickMesh(const std::string& path, uint32_t vertices);

}  // namespace marrow

#endif  // MARROW_TESTS_BENCH_BENCH_MESH_H_
