#include "server/spectrum_service.h"

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "core/operators/bodies.h"
#include "core/spectrum/certified_spectrum.h"
#include "core/spectrum/component_spectrum.h"
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
constexpr double kSolverShare = 0.7;

struct Work {
  Payload payload;
  uint32_t eigen_pairs;
  bool eigenvectors;
  bool strict;
};

double Seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::string KeyOf(const Work& work) {
  DigestBuilder key("marrow spectrum job 2");
  key.AddString(work.payload.digest.sha256.Hex());
  key.AddU64(work.eigen_pairs);
  key.AddU64(work.eigenvectors);
  key.AddU64(work.strict);
  return key.Finish().Hex();
}

// What is done of the call, 0 to 1, as a step of it goes on.
using ReportSteps = std::function<ProgressCallback(double from, double to)>;

// Strict pairs are in double, which the cache does not keep.
absl::StatusOr<CertifiedSpectrum> SolveStrict(
    ServiceContext& context, const Work& work, const CanonicalMesh& mesh,
    const CancelToken& cancel, const ReportSteps& report, SpectrumUse& use) {
  use = {.outcome = CacheOutcome::kMiss, .solver_runs = 1};
  MARROW_ASSIGN_OR_RETURN(
      CertifiedSpectrum spectrum,
      SolveByComponents(mesh, work.eigen_pairs, context.engine.solve_strictly,
                        cancel, report(kMeshShare, 1)));
  if (const double worst = spectrum.residuals.maxCoeff();
      !(worst <= kStrictResidual)) {
    return WithReason(
        absl::InternalError(absl::StrCat(
            "a residual is ", worst, " and not at most ", kStrictResidual,
            ", as a strict spectrum wants it; ask for a usual one")),
        kReasonSolverNotConverged);
  }
  return spectrum;
}

// In double. Where windows of the usual pairs part a cluster, all is solved
// anew strictly.
absl::StatusOr<CertifiedSpectrum> SolveUsual(
    ServiceContext& context, const Work& work, const CanonicalMesh& mesh,
    const CancelToken& cancel, const ReportSteps& report, SpectrumUse& use) {
  use = {.outcome = CacheOutcome::kHit};
  const SpectrumSolver solve = [&](const CanonicalMesh& component,
                                   uint32_t count, const CancelToken&,
                                   const ProgressCallback& progress)
      -> absl::StatusOr<CertifiedSpectrum> {
    SpectrumUse own;
    MARROW_ASSIGN_OR_RETURN(
        const auto pairs,
        context.spectra.Get(
            component, count, cancel,
            [&](double x) { progress(kSolverShare * x); }, own));
    use.Add(own);
    auto spectrum = CertifySpectrum(
        component, *pairs, count, kUsualResidual, cancel,
        [&](double x) { progress(kSolverShare + (1 - kSolverShare) * x); });
    if (spectrum.ok() ||
        ReasonOf(spectrum.status()) != kReasonSolverNotConverged)
      return spectrum;
    use.Add({.outcome = CacheOutcome::kMiss, .solver_runs = 1});
    return context.engine.solve_strictly(component, count, cancel, nullptr);
  };
  return SolveByComponents(mesh, work.eigen_pairs, solve, cancel,
                           report(kMeshShare, 1));
}

// Everything but the last event.
absl::StatusOr<std::shared_ptr<const SpectrumEvents>> Solve(
    ServiceContext& context, const Work& work,
    const std::shared_ptr<const CanonicalMesh>& mesh, SpectrumJob& job,
    SpectrumUse& use) {
  const CancelToken& cancel = *job.cancel();
  const ReportSteps report = [&job](double from, double to) {
    return [&job, from, to](double fraction) {
      job.Progress(v1::STAGE_SPECTRUM, from + (to - from) * fraction);
    };
  };
  const bool values_alone = !work.strict && !work.eigenvectors;
  if (values_alone && mesh->report.components <= 1) {
    MARROW_ASSIGN_OR_RETURN(const auto pairs,
                            context.spectra.Get(*mesh, work.eigen_pairs, cancel,
                                                report(kMeshShare, 1), use));
    return std::make_shared<const SpectrumEvents>(mesh, pairs);
  }
  MARROW_ASSIGN_OR_RETURN(
      CertifiedSpectrum spectrum,
      work.strict ? SolveStrict(context, work, *mesh, cancel, report, use)
                  : SolveUsual(context, work, *mesh, cancel, report, use));
  use.eigen_pairs = spectrum.NumPairs() - 1;
  if (values_alone) {
    auto pairs = std::make_shared<EigenPairs>();
    pairs->eigenvalues = spectrum.eigenvalues;
    pairs->area = spectrum.area;
    return std::make_shared<const SpectrumEvents>(
        mesh, std::shared_ptr<const EigenPairs>(std::move(pairs)));
  }
  return std::make_shared<const SpectrumEvents>(
      mesh, std::make_shared<const CertifiedSpectrum>(std::move(spectrum)),
      work.eigenvectors);
}

absl::Status Compute(ServiceContext& context, const Work& work,
                     SpectrumJob& job) {
  const Clock::time_point begin = Clock::now();
  job.Progress(v1::STAGE_MESH, 0);
  MARROW_ASSIGN_OR_RETURN(
      CanonicalMesh loaded,
      context.engine.load_mesh(*work.payload.bytes, context.options.mesh_limits,
                               *job.cancel()));
  (void)FindBodies(loaded, *job.cancel());  // for the report
  MARROW_RETURN_IF_ERROR(job.cancel()->Check());
  auto mesh = std::make_shared<const CanonicalMesh>(std::move(loaded));
  const Clock::time_point loaded_at = Clock::now();
  job.Progress(v1::STAGE_SPECTRUM, kMeshShare);
  SpectrumUse use;
  MARROW_ASSIGN_OR_RETURN(const auto events,
                          Solve(context, work, mesh, job, use));

  v1::SpectrumEvent last;
  v1::SpectrumCompleted* completed = last.mutable_completed();
  SetMeshDigest(work.payload.digest, completed->mutable_mesh_digest());
  SetGeometryDigest(mesh->geometry_digest,
                    completed->mutable_geometry_digest());
  SetSpectrumUse(use, completed->mutable_spectrum());
  completed->set_solver_revision(kSolverRevision);
  const Clock::time_point end = Clock::now();
  v1::Timings* timings = completed->mutable_timings();
  timings->set_queued_seconds(Seconds(begin - job.created()));
  timings->set_mesh_seconds(Seconds(loaded_at - begin));
  timings->set_spectrum_seconds(Seconds(end - loaded_at));
  timings->set_total_seconds(Seconds(end - job.created()));

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
  work.strict = request.strict();
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
