#include "api/endpoints/pipeline.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "api/endpoints/request_context.h"
#include "api/json/errors.h"
#include "api/request/parse_body.h"
#include "core/execution/dependencies.h"
#include "core/runtime/memory_account.h"
#include "core/runtime/memory_lack.h"

namespace fleetplan::api {

namespace {

/// The memory, in bytes, above which a reply keeps it: less is freed at once, within about a millisecond.
constexpr std::int64_t kMuchMemory = 4 << 20;

/// The longest body, in bytes, of a check or a conversion that usually takes milliseconds.
constexpr std::size_t kShortBody = 1 << 20;

}  // namespace

Reply bounded_work(const RequestContext& context, const std::function<Reply(core::Work&)>& endpoint) {
  core::Work work({context.stop, context.received_at, context.limits.max_plan_memory, context.cpu_clock,
                   context.early_end});
  const std::int64_t lacks = core::memory_lacks();
  try {
    const core::MemoryScope scope(work.memory().get());
    Reply reply = endpoint(work);
    if (work.memory()->used() > kMuchMemory) reply.leftovers = work.memory();
    return reply;
  } catch (const std::bad_alloc&) {
    const bool is_refused = work.memory()->shortages() > 0 && core::memory_lacks() == lacks;
    return is_refused ? memory_exceeded(context) : out_of_memory(context.request_id);
  }
}

Reply memory_exceeded(const RequestContext& context) {
  const double mebibytes = static_cast<double>(context.limits.max_plan_memory) / (1 << 20);
  return problem_reply(ErrorCode::memory_exceeded,
                       "The request needs more than " + number_text(mebibytes) +
                           " MiB of memory, max_plan_memory of /v1/limits: send fewer robots or a map with "
                           "fewer cells.",
                       context.request_id);
}

Reply out_of_memory(const std::string& request_id) {
  return problem_reply(ErrorCode::overloaded,
                       "The service has no memory left for this request at the moment: try again later.",
                       request_id);
}

bool take_turn(Turn* turn, const TurnNeed& need, core::Work& work) {
  work.end_reading();
  return turn == nullptr || (turn->request(need) && turn->await());
}

bool share_turn(Turn* turn) { return turn == nullptr || turn->let_others(); }

double work_of(std::size_t robots, const std::vector<core::RobotPlan>& plans) {
  std::size_t work = robots;
  for (const core::RobotPlan& plan : plans) work += plan.actions.size();
  return static_cast<double>(work);
}

Reply unfinished_reply(std::string_view what, std::string_view fewer, std::chrono::nanoseconds budget,
                       const core::StopCondition& stop, const RequestContext& context) {
  if (stop.cancelled()) return problem_reply(ErrorCode::draining, kDrainingDetail, context.request_id);
  if (core::memory_shortages() > 0) return memory_exceeded(context);
  const auto ms = std::chrono::duration<double, std::milli>(budget).count();
  return problem_reply(
      ErrorCode::check_unfinished,
      std::string(what) + " within " + number_text(ms) +
          " ms: increase options.time_budget_ms, up to max_budget_ms of /v1/limits, or send fewer " +
          std::string(fewer) + '.',
      context.request_id);
}

Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make) {
  return bounded_work(context, [&](core::Work& work) -> Reply {
    bool is_refused = false;
    const auto await_turn = [&] {
      const auto size = static_cast<double>(body.size());
      const std::chrono::milliseconds usual(context.limits.default_budget_ms);
      const core::StopCondition stop =
          work.has_budget() ? work.before_end() : work.until(context.received_at + usual);
      const TurnNeed need{.kind = TurnNeed::Kind::conversion,
                          .stop = stop,
                          .answer_by = stop.deadline(),
                          .work = size,
                          .is_short = body.size() <= kShortBody};
      is_refused = !take_turn(context.turn, need, work);
      return !is_refused;
    };
    auto text = parse_body<std::string>(
        body, context.limits, work, members,
        [&](const JsonReader& root, core::Work& /*work*/) { return make(root, work, await_turn); });
    if (is_refused && !work.cancelled()) return too_busy(context.request_id);
    if (!text) return problem_reply(text.failure(), context.request_id);
    return {200, kJson, std::move(*text)};
  });
}

namespace {

TurnNeed need_of(const ValidateRequest& request, std::string_view body, const core::StopCondition& stop) {
  const double work = work_of(request.robots.size(), request.plans);
  return {.kind = TurnNeed::Kind::check,
          .stop = stop,
          .answer_by = stop.deadline(),
          .work = work,
          .is_short = body.size() <= kShortBody};
}

Reply check(std::string_view body, const RequestContext& context, core::Work& work, const AfterCheck& after) {
  const auto request = parse_validate_request(body, context.limits, work);
  if (!request) return problem_reply(request.failure(), context.request_id);
  const core::StopCondition stop = work.before_end();
  const auto unfinished = [&] {
    return unfinished_reply("The plans could not be checked", kFewerPlans, request->budget, stop, context);
  };
  if (!take_turn(context.turn, need_of(*request, body, stop), work)) {
    return stop.cancelled() ? unfinished() : too_busy(context.request_id);
  }
  const auto report = core::verify({request->grid, request->robots, request->obstacles, &request->zones},
                                   request->plans, request->rules, stop);
  if (!report) return unfinished();
  return after(*request, *report, stop);
}

}  // namespace

Reply check_plans(std::string_view body, const RequestContext& context, const AfterCheck& after) {
  return bounded_work(context, [&](core::Work& work) { return check(body, context, work, after); });
}

PlanDependencies plan_dependencies(const std::vector<core::Robot>& robots,
                                   const std::vector<core::RobotPlan>& plans,
                                   const RequestedDependencies& requested, double tolerance,
                                   bool has_obstacles, const core::StopCondition& stop) {
  const core::DependencyRules rules{requested.margins, requested.slack, tolerance};
  PlanDependencies dependencies;
  dependencies.made = core::dependencies_in_memory(robots, plans, rules, stop);
  if (!dependencies.made) {
    dependencies.warnings.emplace_back(
        "The dependencies could not be made with the time and memory of this request, or are too many: "
        "increase time_budget_ms or dependency_slack.");
  } else if (has_obstacles) {
    dependencies.warnings.emplace_back(
        "The dependencies are between robots only: moving obstacles follow the clock.");
  }
  return dependencies;
}

}  // namespace fleetplan::api
