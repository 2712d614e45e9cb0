#include "server/segment_job.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/cut_job.h"
#include "server/event_builder.h"
#include "server/mesh_warnings.h"
#include "server/run_guarded.h"

namespace marrow {
namespace {

double SecondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

// The cache as one job sees it: adds up what the job took from it.
class JobEigenPairs : public EigenPairSource {
 public:
  explicit JobEigenPairs(SpectrumCache& cache) : cache_(cache) {}

  absl::StatusOr<std::shared_ptr<const EigenPairs>> Get(
      const CanonicalMesh& mesh, uint32_t count, const CancelToken& cancel,
      const ProgressCallback& progress) override {
    return Open(mesh, count)
        ->UpTo(std::numeric_limits<double>::infinity(), cancel, progress);
  }

  std::unique_ptr<EigenPairStream> Open(const CanonicalMesh& mesh,
                                        uint32_t count) override {
    return std::make_unique<Timed>(
        cache_.Open(mesh, count, uses_.emplace_back()), seconds_);
  }

  SpectrumUse use() const {
    SpectrumUse sum;
    for (const SpectrumUse& use : uses_) sum.Add(use);
    return sum;
  }
  double seconds() const { return seconds_; }

 private:
  class Timed : public EigenPairStream {
   public:
    Timed(std::unique_ptr<EigenPairStream> stream, double& seconds)
        : stream_(std::move(stream)), seconds_(seconds) {}

    absl::StatusOr<std::shared_ptr<const EigenPairs>> UpTo(
        double bound, const CancelToken& cancel,
        const ProgressCallback& progress) override {
      const Clock::time_point begin = Clock::now();
      auto pairs = stream_->UpTo(bound, cancel, progress);
      seconds_ += SecondsBetween(begin, Clock::now());
      return pairs;
    }

   private:
    const std::unique_ptr<EigenPairStream> stream_;
    double& seconds_;
  };

  SpectrumCache& cache_;
  std::deque<SpectrumUse> uses_;  // where they are does not change
  double seconds_ = 0;
};

class JobSink : public Sink {
 public:
  JobSink(const SegmentParameters& parameters, SegmentJob& job)
      : parameters_(parameters), outputs_(parameters.outputs), job_(job) {}

  bool OnProgress(Stage stage, double fraction) override {
    return job_.Progress(ToStage(stage), fraction);
  }

  bool OnMesh(const CanonicalMesh& mesh) override {
    mesh_ready_ = Clock::now();
    level_events_.emplace(mesh);
    geometry_digest_ = mesh.geometry_digest;
    v1::SegmentEvent event;
    SetMeshReport(mesh.report, event.mutable_mesh_report());
    SetPrediction(mesh.report, parameters_.options.eigen_pairs,
                  event.mutable_mesh_report());
    job_.Append(std::move(event));
    for (v1::Warning& warning : WarningsAbout(mesh.report)) {
      v1::SegmentEvent warned;
      *warned.mutable_warning() = std::move(warning);
      job_.Append(std::move(warned));
    }
    return Going();
  }

  bool OnLevel(const LevelResult& result) override {
    if (!outputs_.levels.contains(result.level)) return Going();
    Append(level_events_->OfLevel(result.tree, result.level));
    if (outputs_.face_labels) {
      Append(
          LabelEvents(result.level, v1::LABEL_DOMAIN_FACE, result.face_labels));
    }
    if (outputs_.point_labels) {
      Append(LabelEvents(result.level, v1::LABEL_DOMAIN_VERTEX,
                         result.point_labels));
    }
    if (outputs_.skeletons) {
      Append(SkeletonEvents(result.level, result.skeleton));
    }
    if (result.level == 1) first_level_ = Clock::now();
    return Going();
  }

  bool OnTree(const SegmentTree& tree) override {
    level_events_->AddLastSplits(tree, completed_.mutable_completed());
    return Going();
  }

  bool OnSegmentedMesh(std::shared_ptr<const SegmentedMesh> mesh) override {
    result_ = std::move(mesh);
    if (parameters_.cut.has_value()) {
      status_ = AppendCut(*result_, *parameters_.cut, outputs_, job_);
    }
    return status_.ok() && Going();
  }

  // What all cuts are made from; null where the pipeline failed.
  const std::shared_ptr<const SegmentedMesh>& result() const { return result_; }
  // Error of the sink's own.
  const absl::Status& status() const { return status_; }

  // The last event. REQUIRES: the pipeline succeeded.
  v1::SegmentEvent TakeCompleted(const MeshDigest& mesh_digest,
                                 const JobEigenPairs& pairs,
                                 Clock::time_point begin) {
    v1::Completed* completed = completed_.mutable_completed();
    SetMeshDigest(mesh_digest, completed->mutable_mesh_digest());
    SetGeometryDigest(geometry_digest_, completed->mutable_geometry_digest());
    SetSpectrumUse(pairs.use(), completed->mutable_spectrum());
    const Clock::time_point end = Clock::now();
    v1::Timings* timings = completed->mutable_timings();
    timings->set_queued_seconds(SecondsBetween(job_.created(), begin));
    timings->set_mesh_seconds(SecondsBetween(begin, mesh_ready_));
    timings->set_spectrum_seconds(pairs.seconds());
    timings->set_segments_seconds(SecondsBetween(mesh_ready_, end) -
                                  pairs.seconds());
    timings->set_total_seconds(SecondsBetween(job_.created(), end));
    if (first_level_.has_value()) {
      timings->set_first_level_seconds(
          SecondsBetween(job_.created(), *first_level_));
    }
    return std::move(completed_);
  }

 private:
  bool Going() const { return !job_.cancel()->IsCancelled(); }

  void Append(std::vector<v1::SegmentEvent> events) {
    for (v1::SegmentEvent& event : events) job_.Append(std::move(event));
  }

  const SegmentParameters& parameters_;
  const Outputs& outputs_;
  SegmentJob& job_;
  std::optional<LevelEvents> level_events_;
  Digest geometry_digest_;
  Clock::time_point mesh_ready_;
  std::optional<Clock::time_point> first_level_;
  v1::SegmentEvent completed_;
  std::shared_ptr<const SegmentedMesh> result_;
  absl::Status status_;
};

}  // namespace

std::string SegmentJobKey(const MeshDigest& mesh,
                          const SegmentParameters& parameters) {
  const Outputs& outputs = parameters.outputs;
  DigestBuilder key("marrow segment job 1");
  key.AddString(ResultCache::KeyOf(mesh, parameters.options).Hex());
  key.AddU64(outputs.face_labels);
  key.AddU64(outputs.point_labels);
  key.AddU64(outputs.skeletons);
  key.AddU64(outputs.levels.size());
  for (const uint32_t level : outputs.levels) key.AddU64(level);
  key.AddU64(parameters.cut.has_value());
  if (parameters.cut.has_value()) AddToKey(*parameters.cut, key);
  return key.Finish().Hex();
}

void RunSegmentJob(ServiceContext& context, const Payload& payload,
                   const SegmentParameters& parameters,
                   std::shared_ptr<const SegmentedMesh> kept, SegmentJob& job) {
  const Clock::time_point begin = Clock::now();
  const Digest key = ResultCache::KeyOf(payload.digest, parameters.options);
  // Another call may have left it while this one waited for a thread.
  if (kept == nullptr) kept = context.results.Find(key);
  JobEigenPairs pairs(context.spectra);
  JobSink sink(parameters, job);
  const absl::Status status = RunGuarded(*job.cancel(), [&] {
    if (kept != nullptr) return Replay(kept, *job.cancel(), sink);
    return context.engine.run(*payload.bytes, context.options.mesh_limits,
                              parameters.options, pairs, *job.cancel(), sink);
  });
  if (kept == nullptr && sink.result() != nullptr) {
    context.results.Insert(key, sink.result());
  }
  const absl::Status failed = sink.status().ok() ? status : sink.status();
  if (!failed.ok()) return job.Fail(failed);
  v1::SegmentEvent last = sink.TakeCompleted(payload.digest, pairs, begin);
  v1::Completed* completed = last.mutable_completed();
  completed->set_result(kept == nullptr ? v1::CACHE_OUTCOME_MISS
                                        : v1::CACHE_OUTCOME_HIT);
  if (kept != nullptr) {
    SetSpectrumUse(SpectrumUseOf(*kept), completed->mutable_spectrum());
  }
  job.Complete(std::move(last));
}

}  // namespace marrow
