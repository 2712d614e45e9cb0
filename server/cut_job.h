// Cuts the tree of a result and puts the cut into a job's log.
#ifndef MARROW_SERVER_CUT_JOB_H_
#define MARROW_SERVER_CUT_JOB_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "core/base/digest.h"
#include "core/hierarchy/cut.h"
#include "core/pipeline/segmented_mesh.h"
#include "server/request_parser.h"
#include "server/segment_job.h"

namespace marrow {

// Adds what tells one cut from another.
void AddToKey(const CutSpec& cut, DigestBuilder& key);

// The cut, its labels and its skeleton, as the outputs ask for.
// Errors: those of SegmentedMesh::Cut().
absl::Status AppendCut(const SegmentedMesh& mesh, const CutSpec& cut,
                       const Outputs& outputs, SegmentJob& job);

// What every call on this result says of its eigen-pairs.
SpectrumUse SpectrumUseOf(const SegmentedMesh& kept);

// Equal for requests that give equal events.
std::string CutJobKey(const MeshDigest& mesh,
                      const SegmentParameters& parameters);

// Cuts on the calling thread and ends the job. REQUIRES: `parameters` has a
// cut, and `kept` is the result for the rest of them.
void RunCutJob(const MeshDigest& mesh, const SegmentParameters& parameters,
               const std::shared_ptr<const SegmentedMesh>& kept,
               SegmentJob& job);

}  // namespace marrow

#endif  // MARROW_SERVER_CUT_JOB_H_
