// Runs the pipeline for a job and puts what it finds into the job's log.
#ifndef MARROW_SERVER_SEGMENT_JOB_H_
#define MARROW_SERVER_SEGMENT_JOB_H_

#include <memory>
#include <string>

#include "marrow/v1/segmentation_service.pb.h"
#include "server/job.h"
#include "server/request_parser.h"
#include "server/service_context.h"

namespace marrow {

using SegmentJob = Job<v1::SegmentEvent>;

// Equal for requests that give equal events.
std::string SegmentJobKey(const MeshDigest& mesh,
                          const SegmentParameters& parameters);

// Computes on the calling thread and ends the job. `kept` is the result for
// these parameters where it is at hand, which takes milliseconds; null: it is
// looked for once more, or computed and kept.
void RunSegmentJob(ServiceContext& context, const Payload& payload,
                   const SegmentParameters& parameters,
                   std::shared_ptr<const SegmentedMesh> kept, SegmentJob& job);

}  // namespace marrow

#endif  // MARROW_SERVER_SEGMENT_JOB_H_
