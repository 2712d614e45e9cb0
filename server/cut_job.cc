#include "server/cut_job.h"

#include <chrono>
#include <utility>
#include <vector>

#include "core/base/status_macros.h"
#include "server/event_builder.h"
#include "server/run_guarded.h"

namespace marrow {
namespace {

// What Labels and Skeleton call the cut in place of a level.
constexpr uint32_t kCutLevel = 0;

double SecondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

void Append(std::vector<v1::SegmentEvent> events, SegmentJob& job) {
  for (v1::SegmentEvent& event : events) job.Append(std::move(event));
}

}  // namespace

void AddToKey(const CutSpec& cut, DigestBuilder& key) {
  key.AddU64(static_cast<uint64_t>(cut.by));
  key.AddU64(cut.level);
  key.AddU64(cut.segments);
  key.Add(&cut.salience, sizeof(cut.salience));
  for (const auto* nodes : {&cut.closed, &cut.open}) {
    key.AddU64(nodes->size());
    for (const uint32_t node : *nodes) key.AddU64(node);
  }
}

absl::Status AppendCut(const SegmentedMesh& mesh, const CutSpec& spec,
                       const Outputs& outputs, SegmentJob& job) {
  MARROW_ASSIGN_OR_RETURN(const CutResult cut, mesh.Cut(spec, *job.cancel()));
  Append(CutEvents(mesh, cut), job);
  if (outputs.face_labels) {
    Append(LabelEvents(kCutLevel, v1::LABEL_DOMAIN_FACE, cut.face_labels), job);
  }
  if (outputs.point_labels) {
    Append(LabelEvents(kCutLevel, v1::LABEL_DOMAIN_VERTEX, cut.point_labels),
           job);
  }
  if (outputs.skeletons) Append(SkeletonEvents(kCutLevel, cut.skeleton), job);
  return absl::OkStatus();
}

SpectrumUse SpectrumUseOf(const SegmentedMesh& kept) {
  return {CacheOutcome::kHit, 0, kept.EigenPairCount(), kept.OperatorReport()};
}

std::string CutJobKey(const MeshDigest& mesh,
                      const SegmentParameters& parameters) {
  const Outputs& outputs = parameters.outputs;
  DigestBuilder key("marrow cut job 1");
  key.AddString(ResultCache::KeyOf(mesh, parameters.options).Hex());
  key.AddU64(outputs.face_labels);
  key.AddU64(outputs.point_labels);
  key.AddU64(outputs.skeletons);
  AddToKey(*parameters.cut, key);
  return key.Finish().Hex();
}

void RunCutJob(const MeshDigest& mesh, const SegmentParameters& parameters,
               const std::shared_ptr<const SegmentedMesh>& kept,
               SegmentJob& job) {
  const Clock::time_point begin = Clock::now();
  const absl::Status status = RunGuarded(*job.cancel(), [&] {
    return AppendCut(*kept, *parameters.cut, parameters.outputs, job);
  });
  if (!status.ok()) return job.Fail(status);
  v1::SegmentEvent last;
  v1::Completed* completed = last.mutable_completed();
  SetMeshDigest(mesh, completed->mutable_mesh_digest());
  SetGeometryDigest(kept->canonical().geometry_digest,
                    completed->mutable_geometry_digest());
  SetSpectrumUse(SpectrumUseOf(*kept), completed->mutable_spectrum());
  completed->set_result(v1::CACHE_OUTCOME_HIT);
  const Clock::time_point end = Clock::now();
  v1::Timings* timings = completed->mutable_timings();
  timings->set_queued_seconds(SecondsBetween(job.created(), begin));
  timings->set_segments_seconds(SecondsBetween(begin, end));
  timings->set_total_seconds(SecondsBetween(job.created(), end));
  job.Complete(std::move(last));
}

}  // namespace marrow
