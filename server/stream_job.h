// Joins a stream to the job that answers it, and starts that job where it is
// new.
#ifndef MARROW_SERVER_STREAM_JOB_H_
#define MARROW_SERVER_STREAM_JOB_H_

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "server/event_stream.h"
#include "server/job.h"
#include "server/service_context.h"

namespace marrow {

// How the events of a job begin, and what computes the rest of them and ends
// the job. Both are called at most once; `run` on a compute thread.
template <typename Event>
struct JobPlan {
  std::string key;  // equal for requests that may share a job
  std::function<void(Job<Event>&)> open;
  std::function<void(Job<Event>&)> run;
  bool quick = false;  // solves nothing: runs beside those that do
};

// Of a message that tells where the result came from.
template <typename Message>
void JoinResult(Message& message) {
  if (message.result() == v1::CACHE_OUTCOME_MISS)
    message.set_result(v1::CACHE_OUTCOME_JOINED);
}

// A call that joined another's job ran no solver itself and says so.
template <typename Event>
std::shared_ptr<const Event> AdaptForJoiner(
    std::shared_ptr<const Event> event) {
  constexpr bool kHasResult = requires { event->completed().result(); };
  if constexpr (kHasResult) {
    if (event->has_accepted()) {
      auto own = std::make_shared<Event>(*event);
      JoinResult(*own->mutable_accepted());
      return own;
    }
  }
  if (!event->has_completed()) return event;
  auto own = std::make_shared<Event>(*event);
  if constexpr (kHasResult) JoinResult(*own->mutable_completed());
  v1::SpectrumUse* use = own->mutable_completed()->mutable_spectrum();
  if (use->outcome() == v1::CACHE_OUTCOME_MISS) {
    use->set_outcome(v1::CACHE_OUTCOME_JOINED);
    use->set_solver_runs(0);
  }
  return own;
}

template <typename Event>
std::shared_ptr<Job<Event>> NewJob(ServiceContext& context,
                                   const JobPlan<Event>& plan) {
  auto job = std::make_shared<Job<Event>>(
      absl::StrCat(plan.key.substr(0, 12), "-", context.next_job.fetch_add(1)),
      context.options.progress_interval);
  plan.open(*job);
  job->Progress(v1::STAGE_QUEUED, 0);
  context.ticker.Add(job);
  return job;
}

template <typename Event>
void StartJob(ServiceContext& context, JobTable<Event>& table,
              JobPlan<Event> plan, const std::shared_ptr<Job<Event>>& job) {
  ComputePool& pool = plan.quick ? context.quick_pool : context.pool;
  const absl::Status accepted =
      pool.Submit(job->cancel(), [&table, job, key = plan.key, run = plan.run] {
        run(*job);
        table.Remove(key, job.get());
      });
  if (accepted.ok()) return;
  table.Remove(plan.key, job.get());
  job->Fail(accepted);
}

template <typename Event>
void AnswerFromJob(ServiceContext& context, JobTable<Event>& table,
                   StreamState<Event>& stream, JobPlan<Event> plan) {
  auto [job, is_new] =
      table.Join(plan.key, stream.shared_from_this(),
                 [&context, &plan] { return NewJob(context, plan); });
  stream.Begin(job, !is_new, &AdaptForJoiner<Event>);
  if (is_new) StartJob(context, table, std::move(plan), job);
}

}  // namespace marrow

#endif  // MARROW_SERVER_STREAM_JOB_H_
