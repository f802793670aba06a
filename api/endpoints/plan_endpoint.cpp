#include "api/endpoints/plan_endpoint.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <new>
#include <optional>

#include "api/endpoints/bounded_work.h"
#include "api/endpoints/plan_answer.h"
#include "api/endpoints/progress_reporter.h"
#include "api/request/parse_request.h"
#include "api/response/error.h"
#include "core/replan/follow_kept.h"
#include "core/replan/kept_plans.h"

namespace fleetplan::api {

namespace {

using Clock = RequestContext::Clock;

/// The part of the budget for the dependencies of the answer: several times what fleets have needed so far,
/// at most a quarter.
Clock::duration for_dependencies(const PlanRequest& request) {
  if (!request.dependencies.wanted) return Clock::duration::zero();
  constexpr std::chrono::milliseconds kForARobot{4};
  const auto robots = static_cast<std::int64_t>(request.problem.robots().size());
  return std::min<Clock::duration>(request.budget / 4, robots * kForARobot);
}

/// The part of the budget after planning, to check the plan and write the answer: a twentieth of the budget,
/// but at most what a thousand robots need; or a quarter of what reading the request took, which tells how
/// large it is and how busy the machine. The meetings of robots and moving obstacles, and their check, take
/// up to half as long as reading them; the check of a very large map takes up to as long.
Clock::duration kept_for_answer(const PlanRequest& request, Clock::duration reading) {
  constexpr Clock::duration kMostForTheAnswer = std::chrono::milliseconds(25);
  constexpr int kManyCells = 4'000'000;
  const std::chrono::nanoseconds budget = request.budget;
  const core::OccupancyGrid& grid = request.problem.grid();
  const auto for_the_check = [&]() -> Clock::duration {
    if (grid.columns() > kManyCells / grid.rows()) return std::min<Clock::duration>(budget / 2, reading);
    if (!request.problem.obstacles().empty()) return std::min<Clock::duration>(budget / 2, reading / 2);
    return std::min<Clock::duration>(budget / 4, reading / 4);
  };
  return for_dependencies(request) +
         std::max(std::min<Clock::duration>(budget / 20, kMostForTheAnswer), for_the_check());
}

/// What the request asks of the server. A few robots on a small map take milliseconds, as a rule.
TurnNeed need_of(const PlanRequest& request, const core::StopCondition& stop, const RequestContext& context) {
  constexpr std::ptrdiff_t kFewRobots = 16;
  constexpr int kFewCells = 100'000;
  const core::OccupancyGrid& grid = request.problem.grid();
  const auto& robots = request.problem.robots();
  const auto moving =
      std::count_if(robots.begin(), robots.end(), [](const core::Robot& robot) { return bool(robot.goal); });
  const bool is_short = moving <= kFewRobots && grid.columns() <= kFewCells / grid.rows();
  return {TurnNeed::Kind::plan, stop, context.received_at + request.budget,
          static_cast<double>(std::max<std::ptrdiff_t>(1, moving)), is_short};
}

/// So long may a check take beyond the budget if there are previous plans: it decides whether they are kept.
constexpr std::chrono::milliseconds kMostForPrevious{500};

/// The end of planning, after which the answer is checked; later if there are previous plans.
core::StopCondition end_of_planning(const core::StopCondition& stop, const PlanRequest& request) {
  if (!core::have_previous_plans(request.problem.robots())) return stop;
  return stop.until(std::max(stop.deadline(), Clock::now()) + kMostForPrevious);
}

/// The planner's plan, or one that needs no search if the memory does not suffice for any other.
core::Plan plan_or_none(const Planner& planner, const PlanRequest& request, const core::StopCondition& stop,
                        core::Observer* observer) {
  try {
    return planner(request.problem, request.options, stop, observer);
  } catch (const std::bad_alloc&) {
    const auto patience =
        core::StopCondition::even_if_cancelled(std::max(stop.deadline(), Clock::now()) + kMostForPrevious);
    return core::plan_without_search(request.problem, request.options, core::kMemorySpent,
                                     patience.despite_memory());
  }
}

Reply planned(const Planner& planner, std::string_view body, const RequestContext& context,
              core::Work& work) {
  Stages stages{context.received_at, {}, {}, {}, {}};
  const auto begin = Clock::now();
  const auto request = parse_request(body, context.limits, work, context.maps);
  if (!request) return problem_reply(request.failure(), context.request_id);
  stages.parsed = Clock::now();

  const core::StopCondition stop = work.before_end(kept_for_answer(*request, stages.parsed - begin));
  const auto answer = [&](const core::Plan& plan, const AnsweredPlan& on_answer) {
    return plan_answer(plan, *request, context.request_id, stages, end_of_planning(stop, *request),
                       on_answer);
  };
  work.end_reading();
  const bool has_turn = context.turn == nullptr || context.turn->request(need_of(*request, stop, context));
  if (!has_turn) return too_busy(context.request_id);
  std::optional<ProgressReporter> reporter;
  if (context.events != nullptr) {
    const std::size_t robots = request->problem.robots().size();
    context.events->begin({robots});
    reporter.emplace(*context.events, robots, stop.deadline(),
                     [&](const core::Plan& better) { return answer(better, {}); });
  }
  const bool has_come = context.turn == nullptr || context.turn->await();
  stages.started = Clock::now();
  if (stop.cancelled()) {
    return problem_reply(ErrorCode::draining, kDrainingDetail, context.request_id);
  }
  if (!has_come) return too_busy(context.request_id);
  // Previous plans that hold are kept whatever the budget.
  if (stop.met() && !core::have_previous_plans(request->problem.robots())) {
    const auto patience = core::StopCondition::even_if_cancelled(Clock::now() + kMostForPrevious);
    Reply reply =
        answer(core::plan_without_search(request->problem, request->options,
                                         "The time budget was spent before planning could begin.", patience),
               context.answered);
    if (reply.outcome) reply.outcome->plan_seconds.reset();
    return reply;
  }
  const core::Plan plan = plan_or_none(planner, *request, stop, reporter ? &*reporter : nullptr);
  return reporter && reporter->rejection() ? *reporter->rejection() : answer(plan, context.answered);
}

}  // namespace

Reply plan_endpoint(std::string_view body, const RequestContext& context) {
  core::CallerThread callers_thread;
  core::Executor& executor = context.executor != nullptr ? *context.executor : callers_thread;
  const auto planner = [&](const core::Problem& problem, const core::PlanOptions& options,
                           const core::StopCondition& stop, core::Observer* observer) {
    return core::plan(problem, options, stop, executor, observer);
  };
  return plan_with(planner, body, context);
}

Reply plan_with(const Planner& planner, std::string_view body, const RequestContext& context) {
  return bounded_work(context, [&](core::Work& work) { return planned(planner, body, context, work); });
}

}  // namespace fleetplan::api
