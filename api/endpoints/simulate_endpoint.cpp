#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "api/json/error.h"
#include "api/json/faults.h"
#include "api/request/parse_request.h"
#include "api/response/write_response.h"
#include "core/runtime/memory_account.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

namespace {

using Clock = RequestContext::Clock;

/// Returns when no further run is made: a part of the budget is for the answer.
core::StopCondition end_of_runs(const core::Work& work, const SimulateRequest& request) {
  constexpr std::chrono::milliseconds kAnswerTime{50};
  const auto answer = std::min<std::chrono::nanoseconds>(request.budget / 10, kAnswerTime);
  return work.before_end(answer);
}

TurnNeed need_of(const SimulateRequest& request, const core::StopCondition& stop) {
  const double work = work_of(request.robots.size(), request.plans);
  return {.kind = TurnNeed::Kind::simulation,
          .stop = stop,
          .answer_by = stop.deadline(),
          .work = work,
          .is_short = false};
}

/// Returns the dependencies with positions in the list of plans as robots.
std::vector<core::Dependency> by_plan(const SimulateRequest& request) {
  std::vector<std::size_t> plan_of(request.robots.size(), 0);
  for (std::size_t k = 0; k < request.plans.size(); ++k) plan_of[request.plans[k].robot] = k;
  std::vector<core::Dependency> dependencies = request.dependencies;
  for (core::Dependency& dependency : dependencies) {
    dependency.gate.robot = plan_of[dependency.gate.robot];
    dependency.until.robot = plan_of[dependency.until.robot];
  }
  return dependencies;
}

core::SimulatedFleet fleet_of(const SimulateRequest& request) {
  core::PlannedExecution execution{request.plans, {}};
  // By a clock, added waits absorb delays; without one, they have to last.
  const bool keeps_added_waits = request.policy == core::ExecutionPolicy::dependencies;
  const double added_wait = keeps_added_waits ? request.wait_before_move : 0.0;
  for (const core::RobotPlan& plan : request.plans) {
    execution.purposes.push_back(core::wait_purposes(request.robots[plan.robot], plan.actions, added_wait));
  }
  execution.policy = request.policy;
  execution.max_delay = request.max_delay;
  execution.dependencies = by_plan(request);
  return {request.grid, request.robots, request.body_radii, std::move(execution)};
}

/// Returns the text of the requested trace. None, with a warning, if it has too many actions for an answer,
/// or is not made in half of the time: the rest is for the runs.
std::optional<std::string> requested_trace(const core::SimulatedFleet& fleet, SimulateRequest& request,
                                           const Limits& limits, const core::StopCondition& stop) {
  // A small request may have a million stops and bends; its answer is in proportion to its plans.
  constexpr std::size_t kActionsOfAny = 20'000;
  constexpr std::size_t kActionsOfOne = 200;
  if (!request.trace) return std::nullopt;
  std::size_t planned = 0;
  for (const core::RobotPlan& plan : request.plans) planned += plan.actions.size();
  const std::size_t most = std::min(limits.max_actions, kActionsOfAny + kActionsOfOne * planned);
  const core::StopCondition half = core::after_share(stop, 0.5);
  const auto trace = core::trace_run(fleet, request.settings, *request.trace, most, half);
  auto text = trace ? write_trace(*trace, request, half) : std::nullopt;
  if (!text) {
    request.warnings.push_back("The trace is left out: it has more than " + std::to_string(most) +
                               " actions, or takes more than half of the time budget or too much memory.");
  }
  return text;
}

/// The runs of a simulation, and how long it waited meanwhile for others that had their turn.
struct Runs {
  core::SimulationReport report;
  Clock::duration waited = Clock::duration::zero();
};

/// Executes the runs in the caller's thread and, if they are idle, in others. Lets others have their turns in
/// between.
Runs run_all(const core::SimulatedFleet& fleet, const SimulateRequest& request,
             const core::StopCondition& stop, const RequestContext& context) {
  core::CallerThread callers_thread;
  core::Executor& executor = context.executor != nullptr ? *context.executor : callers_thread;
  Runs runs;
  const auto go_on = [&](const core::SimulationProgress& progress) {
    if (context.events != nullptr) context.events->progress({request.robots.size(), {}, progress});
    const auto before = Clock::now();
    const bool goes_on = progress.done == 0 || context.turn == nullptr || context.turn->let_others();
    runs.waited += Clock::now() - before;
    return goes_on;
  };
  runs.report = core::simulate(fleet, request.settings, stop, executor, go_on);
  return runs;
}

/// Returns the warning about runs that were not finished.
std::string cut_warning(const Runs& runs, const SimulateRequest& request) {
  constexpr std::chrono::milliseconds kMuch{10};
  const auto ms = [](std::chrono::nanoseconds time) {
    return number_text(std::round(std::chrono::duration<double, std::milli>(time).count())) + " ms";
  };
  const core::SimulationProgress& totals = runs.report.totals;
  std::string text = "Only the first " + std::to_string(totals.done) + " of " + std::to_string(totals.runs) +
                     " runs were finished within the time budget of " + ms(request.budget);
  if (runs.waited >= kMuch) text += ", of which " + ms(runs.waited) + " went to other requests";
  if (core::memory_shortages() > 0) text += ", or within the memory that a request is granted";
  return text + '.';
}

Reply simulated(std::string_view body, const RequestContext& context, core::Work& work) {
  auto request = parse_simulate_request(body, context.limits, work);
  if (!request) return problem_reply(request.failure(), context.request_id);
  const core::StopCondition stop = end_of_runs(work, *request);
  const auto unfinished = [&] {
    return unfinished_reply("Not a single run was finished", kFewerPlans, request->budget, stop, context);
  };
  work.end_reading();
  if (context.turn != nullptr && !context.turn->request(need_of(*request, stop))) {
    return too_busy(context.request_id);
  }
  if (context.events != nullptr) {
    context.events->begin({request->robots.size(), {}, core::SimulationProgress{0, request->settings.runs}});
  }
  const auto asked = Clock::now();
  if (context.turn != nullptr && !context.turn->await()) {
    return stop.cancelled() ? unfinished() : too_busy(context.request_id);
  }
  const auto waited = Clock::now() - asked;
  const core::SimulatedFleet fleet = fleet_of(*request);
  const auto trace = requested_trace(fleet, *request, context.limits, stop);
  Runs runs = run_all(fleet, *request, stop, context);
  runs.waited += waited;
  const core::SimulationProgress& totals = runs.report.totals;
  if (totals.done == 0) return unfinished();
  if (totals.done < totals.runs) request->warnings.push_back(cut_warning(runs, *request));
  return {200, kJson, write_simulation(runs.report, *request, trace, context.request_id)};
}

}  // namespace

Reply simulate_endpoint(std::string_view body, const RequestContext& context) {
  return bounded_work(context, [&](core::Work& work) { return simulated(body, context, work); });
}

}  // namespace fleetplan::api
