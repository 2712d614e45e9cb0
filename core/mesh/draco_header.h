// What a Draco file says about itself, read without decoding it.
//
// Draco allocates by the counts that a file declares, so a hundred bytes can
// cost gigabytes. These functions read the parts that are stored plainly (the
// layout of bitstreams 2.0 to 2.2) and refuse what cannot be honest or is over
// a limit. They allocate nothing but messages, never read past the end and are
// linear in the bytes they read. Errors are as in decode.h. Thread safe.
#ifndef MARROW_CORE_MESH_DRACO_HEADER_H_
#define MARROW_CORE_MESH_DRACO_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/mesh/decode.h"

namespace marrow {

enum class DracoMethod : uint8_t { kSequential = 0, kEdgebreaker = 1 };

struct DracoHeader {
  uint8_t version_minor = 0;  // of version 2
  DracoMethod method = DracoMethod::kSequential;
  // As declared, within the limits. Edgebreaker: vertices of the connectivity,
  // which attribute seams split into more points. Sequential: points.
  uint64_t faces = 0;
  uint64_t vertices = 0;
};

// Reads from the first byte to the counts of the connectivity.
absl::StatusOr<DracoHeader> ParseDracoHeader(std::string_view bytes,
                                             const MeshLimits& limits);

// Checks the descriptions of the attributes, which begin at `offset`, behind
// the connectivity: one POSITION of three 32- or 64-bit floats, at most 64
// attributes, and not more than 1 GiB to hold all values of `points` points.
absl::Status CheckDracoAttributes(std::string_view bytes, size_t offset,
                                  DracoMethod method, uint64_t points);

}  // namespace marrow

#endif  // MARROW_CORE_MESH_DRACO_HEADER_H_
