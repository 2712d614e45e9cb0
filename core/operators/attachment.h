// What is in no body, and whose labels it has.
#ifndef MARROW_CORE_OPERATORS_ATTACHMENT_H_
#define MARROW_CORE_OPERATORS_ATTACHMENT_H_

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/cancel_token.h"
#include "core/mesh/triangle_mesh.h"

namespace marrow {

// A component is worn where so much of its area is near larger ones; or near
// others, such as what is worn over it, and so much nearest to one larger one.
inline constexpr double kWornShare = 0.9;
inline constexpr double kWearerShare = 0.75;
// What touches a body here and there is attached where it does so most: within
// so much of its own breadth of where it is nearest.
inline constexpr double kContact = 0.1;

// Which of several components lie all over on larger ones, no farther from them
// than `near`, as clothes do on a body, a hidden body in its suit, and copies
// on each other. Not what is closed and so thin that its far side is near too:
// a wing on a trunk, a leg beside another. `components`: the faces of each, the
// largest first. None is worn by nothing but what is worn itself.
// Deterministic, O(n log^2 n). Errors: CANCELLED. Thread safe.
absl::StatusOr<std::vector<bool>> FindWorn(
    const TriangleMesh& mesh,
    const std::vector<std::vector<uint32_t>>& components, double near,
    const CancelToken& cancel);

// Faces that are attached together.
struct Attachment {
  std::vector<uint32_t> faces;  // not empty
  bool is_worn = false;         // a face each to the face beneath it
};

// Writes for every face of `attached` the face of a body whose labels it takes.
// `bodies`: the faces of all; not empty, and their own anchors. `near`, the
// bridging distance, is how far apart points inside of coarse faces may be.
// Deterministic, about O(n log n). Errors: CANCELLED. Thread safe.
absl::Status Attach(const TriangleMesh& mesh, std::vector<uint32_t> bodies,
                    const std::vector<Attachment>& attached, double near,
                    const CancelToken& cancel, std::vector<uint32_t>& anchors);

}  // namespace marrow

#endif  // MARROW_CORE_OPERATORS_ATTACHMENT_H_
