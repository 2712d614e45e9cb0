#include "server/spectrum_service.h"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "core/base/status_macros.h"
#include "server/event_builder.h"
#include "server/event_stream.h"
#include "server/request_parser.h"
#include "server/run_guarded.h"
#include "server/status.h"
#include "server/stream_job.h"

namespace marrow {
namespace {

using SpectrumJob = Job<v1::SpectrumEvent>;
using Plan = JobPlan<v1::SpectrumEvent>;

// Shares of the whole call, for Progress.
constexpr double kMeshShare = 0.1;

struct Work {
  Payload payload;
  uint32_t eigen_pairs;
  bool eigenvectors;
};

double Seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::string KeyOf(const Work& work) {
  DigestBuilder key("marrow spectrum job 1");
  key.AddString(work.payload.digest.sha256.Hex());
  key.AddU64(work.eigen_pairs);
  key.AddU64(work.eigenvectors);
  return key.Finish().Hex();
}

absl::Status Compute(ServiceContext& context, const Work& work,
                     SpectrumJob& job) {
  const Clock::time_point begin = Clock::now();
  job.Progress(v1::STAGE_MESH, 0);
  MARROW_ASSIGN_OR_RETURN(
      CanonicalMesh loaded,
      context.engine.load_mesh(*work.payload.bytes,
                               context.options.mesh_limits));
  auto mesh = std::make_shared<const CanonicalMesh>(std::move(loaded));
  const Clock::time_point loaded_at = Clock::now();
  job.Progress(v1::STAGE_SPECTRUM, kMeshShare);
  SpectrumUse use;
  MARROW_ASSIGN_OR_RETURN(
      auto pairs, context.spectra.Get(
                      *mesh, work.eigen_pairs, *job.cancel(),
                      [&job](double fraction) {
                        job.Progress(v1::STAGE_SPECTRUM,
                                     kMeshShare + (1 - kMeshShare) * fraction);
                      },
                      use));

  v1::SpectrumEvent last;
  v1::SpectrumCompleted* completed = last.mutable_completed();
  SetMeshDigest(work.payload.digest, completed->mutable_mesh_digest());
  SetGeometryDigest(mesh->geometry_digest,
                    completed->mutable_geometry_digest());
  SetSpectrumUse(use, completed->mutable_spectrum());
  const Clock::time_point end = Clock::now();
  v1::Timings* timings = completed->mutable_timings();
  timings->set_queued_seconds(Seconds(begin - job.created()));
  timings->set_mesh_seconds(Seconds(loaded_at - begin));
  timings->set_spectrum_seconds(Seconds(end - loaded_at));
  timings->set_total_seconds(Seconds(end - job.created()));

  const auto events =
      std::make_shared<SpectrumEvents>(mesh, pairs, work.eigenvectors);
  job.CompleteLazily(events->count() + 1, [events, last](uint64_t index) {
    return index < events->count() ? events->Make(index) : last;
  });
  return absl::OkStatus();
}

absl::StatusOr<Plan> MakePlan(ServiceContext& context,
                              const v1::ComputeSpectrumRequest& request,
                              StreamState<v1::SpectrumEvent>& stream) {
  if (context.draining) return Draining();
  Work work;
  work.eigenvectors = request.include_eigenvectors();
  MARROW_ASSIGN_OR_RETURN(
      work.eigen_pairs, ParseEigenPairs(request.has_eigen_pairs(),
                                        request.eigen_pairs(), "eigen_pairs"));
  MARROW_ASSIGN_OR_RETURN(work.payload,
                          ResolveMesh(request.has_mesh(), request.mesh(),
                                      context.options, context.store));
  stream.Describe("mesh", work.payload.digest.sha256.Hex().substr(0, 12));
  Plan plan;
  plan.key = KeyOf(work);
  plan.open = [](SpectrumJob&) {};
  plan.run = [&context, work](SpectrumJob& job) {
    const absl::Status status =
        RunGuarded(*job.cancel(), [&] { return Compute(context, work, job); });
    if (!status.ok()) job.Fail(status);
  };
  return plan;
}

}  // namespace

grpc::ServerWriteReactor<v1::SpectrumEvent>* SpectrumService::ComputeSpectrum(
    grpc::CallbackServerContext* call,
    const v1::ComputeSpectrumRequest* request) {
  auto* reactor = new EventStream<v1::SpectrumEvent>(
      context_, *call, "SpectrumService.ComputeSpectrum");
  const auto stream = reactor->state();
  absl::StatusOr<Plan> plan = MakePlan(context_, *request, *stream);
  if (plan.ok()) {
    AnswerFromJob(context_, context_.spectrum_jobs, *stream, *std::move(plan));
  } else {
    stream->Begin(plan.status(), false, nullptr);
  }
  return reactor;
}

}  // namespace marrow
