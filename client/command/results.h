// An answer in the order of the user's file, and the files made of it.
#ifndef MARROW_CLIENT_COMMAND_RESULTS_H_
#define MARROW_CLIENT_COMMAND_RESULTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/command/arguments.h"
#include "client/command/result_folder.h"
#include "client/encoder/order_map.h"
#include "client/polygon_mesh.h"
#include "client/segmentation.h"

namespace marrow::client {

// Labels and medial structures of `answer`, which are in the payload's order,
// in the file's. Errors: INTERNAL where the two do not fit.
absl::StatusOr<Segmentation> InFileOrder(Segmentation answer,
                                         const OrderMap& order);

absl::Status PutInFileOrder(const OrderMap& order, Cut& cut);

struct ResultOptions {
  bool parts = false;  // STEM.parts.obj
  bool png = false;    // STEM.cut.png, STEM.level-N.png
  // Looked at before each picture, which takes a second or so.
  absl::Time deadline = absl::InfiniteFuture();
};

// All files of one input, in memory. `name` is what the JSON calls the mesh,
// and `cut` what was asked for. DEADLINE_EXCEEDED where a picture would come
// too late.
absl::StatusOr<std::vector<ResultFile>> MakeResultFiles(
    const std::string& name, const PolygonMesh& mesh,
    const Segmentation& segmentation, const ResultOptions& options,
    const CutChoice& cut);

// The same of a cut alone: STEM.cut.*.
absl::StatusOr<std::vector<ResultFile>> MakeCutFiles(
    const std::string& name, const PolygonMesh& mesh, const CutAnswer& answer,
    const ResultOptions& options, const CutChoice& cut);

// "6 segments at level 1, 21 at level 2, 14 in the cut".
std::string CountSegments(const Segmentation& segmentation);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_RESULTS_H_
