#include "api/endpoints/endpoints.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/advance/advance_request.h"
#include "api/endpoints/pipeline.h"
#include "api/execution/execution_requests.h"
#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/request/parse_body.h"
#include "api/request/parse_request.h"
#include "api/response/write_response.h"
#include "api/travel/travel_requests.h"
#include "api/vda5050/export.h"
#include "api/vda5050/import.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "core/runtime/memory_account.h"
#include "core/runtime/shared_turn.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/travel_times.h"

namespace fleetplan::api {

Reply validate_endpoint(std::string_view body, const RequestContext& context) {
  return check_plans(
      body, context,
      [](const ValidateRequest& request, const core::VerifyReport& report,
         const core::StopCondition&) -> Reply {
        return {200, kJson, write_report(report, request.robots, request.obstacles, request.zones)};
      });
}

namespace {

/// Returns a JSON Pointer to the action of a robot at time `t`. If there is no action, to its plan. If it has
/// no plan, to the robot.
std::string pointer_to(std::size_t robot, double t, const std::vector<core::RobotPlan>& plans) {
  const auto plan = std::find_if(plans.begin(), plans.end(),
                                 [robot](const core::RobotPlan& one) { return one.robot == robot; });
  if (plan == plans.end()) return "/robots/" + std::to_string(robot);
  std::string pointer = "/plans/" + std::to_string(plan - plans.begin());
  const auto action = std::find_if(plan->actions.begin(), plan->actions.end(), [t](const core::Action& one) {
    return one.t_start <= t && t <= one.t_end;
  });
  if (action == plan->actions.end()) return pointer;
  return pointer + "/actions/" + std::to_string(action - plan->actions.begin());
}

/// Returns the 422 for plans that the check rejects, with its violations as faults.
RequestError invalid_plans(const ValidateRequest& request, const core::VerifyReport& report) {
  RequestError error;
  error.detail = "The plans are not valid, so there are no dependencies; see errors and /v1/validate.";
  error.faults_total = report.violation_count;
  // Bounded: at most FaultList::kMaxListed.
  for (const core::Violation& violation : report.violations) {
    if (error.faults.size() == FaultList::kMaxListed) break;
    std::string names;
    for (const std::size_t robot : violation.robots) {
      names += (names.empty() ? "" : ", ") + request.robots[robot].id;
    }
    error.faults.push_back({pointer_to(violation.robots.back(), violation.t, request.plans),
                            fault::kInvalidPlan, names + ": " + violation.detail + "."});
  }
  return error;
}

std::string write(const PlanDependencies& dependencies, const std::vector<core::Robot>& robots) {
  JsonWriter json;
  json.begin_object();
  write_dependencies(json, dependencies.made ? &*dependencies.made : nullptr, robots);
  json.key("warnings").begin_array();
  for (const std::string& warning : dependencies.warnings) json.value(std::string_view(warning));
  json.end_array().end_object();
  return json.take();
}

}  // namespace

Reply dependencies_endpoint(std::string_view body, const RequestContext& context) {
  return check_plans(body, context,
                     [&](const ValidateRequest& request, const core::VerifyReport& report,
                         const core::StopCondition& stop) -> Reply {
                       if (!report.valid()) {
                         return problem_reply(invalid_plans(request, report), context.request_id);
                       }
                       const double tolerance = request.rules.tolerances.front().metres;
                       const auto made =
                           plan_dependencies(request.robots, request.plans, request.dependencies, tolerance,
                                             !request.obstacles.empty(), stop);
                       return {200, kJson, write(made, request.robots)};
                     });
}

namespace {

constexpr std::array<std::string_view, 9> kAdvanceMembers{
    "request", "plans", "at", "commit", "states", "poses", "holds", "goals", "pose_tolerance"};

constexpr std::array<std::string_view, 8> kRetimeMembers{
    "robots", "robot_defaults", "plans", "dependencies", "at", "states", "options", "metadata"};

}  // namespace

Reply advance_endpoint(std::string_view body, const RequestContext& context) {
  const auto next_request = [&](const JsonReader& root, core::Work& work,
                                const AwaitTurn& await_turn) -> std::optional<std::string> {
    auto request = parse_advance_request(root, context.limits, work);
    if (!request || !await_turn()) return std::nullopt;
    const core::Judgement judgement = judgement_of(*request, context.maps, work);
    const core::AdvancedFleet next = core::advance(request->now, judgement, work);
    if (work.met()) return std::nullopt;
    return write_advanced(*request, next.robots, next.circumstances, work);
  };
  return pure_endpoint(body, context, kAdvanceMembers, next_request);
}

Reply retime_endpoint(std::string_view body, const RequestContext& context) {
  const auto retimed = [&](const JsonReader& root, core::Work& work,
                           const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto request = parse_retime_request(root, context.limits, work);
    if (!request || !await_turn()) return std::nullopt;
    const auto times = core::retime(request->robots, core::executed_actions(request->robots, request->plans),
                                    request->dependencies, request->states, request->rules, work.reading());
    if (!times) return std::nullopt;
    return write_retimed(*request, *times, work);
  };
  return pure_endpoint(body, context, kRetimeMembers, retimed);
}

Reply vda5050_endpoint(std::string_view body, const RequestContext& context) {
  const auto orders = [&](const JsonReader& root, core::Work& work,
                          const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto request = parse_vda5050_request(root, context.limits, work);
    if (!request || !await_turn()) return std::nullopt;
    return write_orders(*request, work);
  };
  return pure_endpoint(body, context, kVdaMembers, orders);
}

Reply import_vda5050_endpoint(std::string_view body, const RequestContext& context) {
  const auto states = [&](const JsonReader& root, core::Work& work,
                          const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto import = parse_vda5050_import(root, context.limits, work);
    if (!import || !await_turn()) return std::nullopt;
    return write_states(*import, work);
  };
  return pure_endpoint(body, context, kVdaImportMembers, states);
}

namespace {

std::size_t cells_of(const core::OccupancyGrid& grid) {
  return static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows());
}

/// The amount of work: a search of the map for each goal, and a short search for each way.
struct TravelWork {
  std::size_t ways = 0;
  std::size_t goals = 0;
  std::size_t cells = 0;  // of the map

  bool is_short() const {
    constexpr std::size_t kFewWays = 100;
    constexpr std::size_t kFewCells = 1'000'000;
    return ways <= kFewWays && goals * cells <= kFewCells;
  }
  /// Proportional to the expected time, at least 1.
  double amount() const {
    constexpr double kCellsOfAWay = 100.0;
    return 1.0 + static_cast<double>(goals) * static_cast<double>(cells) +
           kCellsOfAWay * static_cast<double>(ways);
  }
};

/// The computation of travel times for one request, in its turn. If it has a reply instead of an answer, it
/// keeps the reply until the reading of the body has ended.
class Travelling {
 public:
  Travelling(const RequestContext& context, core::Work& work) : context_(context), work_(work) {}

  /// Waits for the turn of a request; returns false if it does not come.
  bool begin(const TravelWork& effort, std::chrono::nanoseconds budget) {
    budget_ = budget;
    stop_ = work_.before_end(core::budget::for_answer_of_travel(budget));
    const TurnNeed need{.kind = TurnNeed::Kind::travel,
                        .stop = *stop_,
                        .answer_by = stop_->deadline(),
                        .work = effort.amount(),
                        .is_short = effort.is_short()};
    if (take_turn(context_.turn, need, work_)) return true;
    if (!work_.cancelled()) reply_ = too_busy(context_.request_id);
    return false;
  }

  const core::StopCondition& stop() const { return *stop_; }
  core::Executor& executor() { return context_.executor != nullptr ? *context_.executor : callers_thread_; }
  std::function<bool()> go_on() const {
    return [turn = context_.turn] { return share_turn(turn); };
  }

  /// Keeps the reply that the time did not suffice, and returns nothing. `what` and `fewer`: see
  /// unfinished_reply.
  std::optional<std::string> unfinished(std::string_view what, std::string_view fewer) {
    reply_ = unfinished_reply(what, fewer, budget_, *stop_, context_);
    return std::nullopt;
  }
  const std::optional<Reply>& reply() const { return reply_; }

 private:
  const RequestContext& context_;
  core::Work& work_;
  core::CallerThread callers_thread_;
  std::chrono::nanoseconds budget_{};
  std::optional<core::StopCondition> stop_;
  std::optional<Reply> reply_;
};

using MakeTravelAnswer =
    std::function<std::optional<std::string>(const JsonReader&, core::Work&, Travelling&)>;

Reply travel_endpoint(std::string_view body, const RequestContext& context,
                      std::span<const std::string_view> members, const MakeTravelAnswer& make) {
  return bounded_work(context, [&](core::Work& work) -> Reply {
    Travelling travelling(context, work);
    auto text = parse_body<std::string>(
        body, context.limits, work, members,
        [&](const JsonReader& root, core::Work& reading) { return make(root, reading, travelling); });
    if (travelling.reply()) return *travelling.reply();
    if (!text) return problem_reply(text.failure(), context.request_id);
    return {200, kJson, std::move(*text)};
  });
}

}  // namespace

Reply matrix_endpoint(std::string_view body, const RequestContext& context) {
  constexpr std::string_view kWhat = "Not all travel times could be computed";
  const auto matrix = [&](const JsonReader& root, core::Work& work,
                          Travelling& travelling) -> std::optional<std::string> {
    const auto request = parse_matrix_request(root, context.limits, work, context.maps);
    if (!request) return std::nullopt;
    const TravelWork effort{.ways = request->from.distinct.size() * request->to.distinct.size(),
                            .goals = request->to.distinct.size(),
                            .cells = cells_of(request->map->grid())};
    if (!travelling.begin(effort, request->budget)) return std::nullopt;
    const auto answers = matrix_times(*request, travelling.stop(), travelling.executor(), travelling.go_on());
    auto text = answers ? write_matrix(*request, *answers, work.before_end()) : std::nullopt;
    return text ? std::move(text) : travelling.unfinished(kWhat, "poses");
  };
  return travel_endpoint(body, context, kMatrixMembers, matrix);
}

Reply assign_endpoint(std::string_view body, const RequestContext& context) {
  const auto with_goals = [&](const JsonReader& root, core::Work& work,
                              Travelling& travelling) -> std::optional<std::string> {
    const auto request = parse_assign_request(root, context.limits, work, context.maps);
    if (!request) return std::nullopt;
    const PlanRequest& plan = request->plan;
    const TravelWork effort{.ways = plan.problem.robots().size() * request->tasks.size(),
                            .goals = request->tasks.size(),
                            .cells = cells_of(plan.problem.grid())};
    if (!travelling.begin(effort, plan.budget)) return std::nullopt;
    const auto arrivals = core::arrivals(plan.problem, plan.options, request->tasks, travelling.stop(),
                                         travelling.executor(), travelling.go_on());
    const auto tasks = arrivals ? assigned(*request, *arrivals, travelling.stop()) : std::nullopt;
    if (!tasks) return travelling.unfinished("The tasks could not be assigned", "tasks");
    return write_assigned(*request, *tasks);
  };
  return travel_endpoint(body, context, kAssignMembers, with_goals);
}

namespace {

/// Returns when no further run is made: a part of the budget is for the answer.
core::StopCondition end_of_runs(const core::Work& work, const SimulateRequest& request) {
  return work.before_end(core::budget::for_answer_of_runs(request.budget));
}

TurnNeed need_of(const SimulateRequest& request, const core::StopCondition& stop) {
  const double work = work_of(request.robots.size(), request.plans);
  return {.kind = TurnNeed::Kind::simulation,
          .stop = stop,
          .answer_by = stop.deadline(),
          .work = work,
          .is_short = false};
}

core::SimulatedFleet fleet_of(const SimulateRequest& request) {
  return {request.grid, request.robots, request.body_radii,
          core::planned_execution(request.robots, request.plans, request.policy, request.max_delay,
                                  request.wait_before_move, request.dependencies)};
}

/// Returns the text of the requested trace. None, with a warning, if it has too many actions for an answer,
/// or takes more than half of the time, because the rest is for the runs.
std::optional<std::string> requested_trace(const core::SimulatedFleet& fleet, SimulateRequest& request,
                                           const Limits& limits, const core::StopCondition& stop) {
  // A small request may have a million stops and bends; its answer is in proportion to its plans.
  constexpr std::size_t kActionsOfAny = 20'000;
  constexpr std::size_t kActionsOfOne = 200;
  if (!request.trace) return std::nullopt;
  std::size_t planned = 0;
  for (const core::RobotPlan& plan : request.plans) planned += plan.actions.size();
  const std::size_t max_actions = std::min(limits.max_actions, kActionsOfAny + kActionsOfOne * planned);
  const core::StopCondition half = core::after_share(stop, 0.5);
  const auto trace = core::trace_run(fleet, request.settings, *request.trace, max_actions, half);
  auto text = trace ? write_trace(*trace, request, half) : std::nullopt;
  if (!text) {
    request.warnings.push_back("The trace is left out: it has more than " + std::to_string(max_actions) +
                               " actions, or takes more than half of the time budget or too much memory.");
  }
  return text;
}

/// The runs of a simulation, and how long it waited meanwhile for others that had their turn.
struct Runs {
  core::SimulationReport report;
  RequestContext::Clock::duration waited = RequestContext::Clock::duration::zero();
};

/// Executes the runs in the caller's thread and, if they are idle, in others. Lets others have their turns
/// meanwhile, as soon as one run is done.
Runs run_all(const core::SimulatedFleet& fleet, const SimulateRequest& request,
             const core::StopCondition& stop, const RequestContext& context) {
  core::CallerThread callers_thread;
  core::Executor& executor = context.executor != nullptr ? *context.executor : callers_thread;
  Runs runs;
  std::atomic<bool> any_done = false;
  core::SharedTurn turn(stop, [&] {
    if (!any_done) return true;
    const auto before = RequestContext::Clock::now();
    const bool goes_on = share_turn(context.turn);
    runs.waited += RequestContext::Clock::now() - before;
    return goes_on;
  });
  const auto go_on = [&](const core::SimulationProgress& progress) {
    if (context.events != nullptr) context.events->progress({request.robots.size(), {}, progress});
    any_done = progress.done > 0;
    return turn.share();
  };
  runs.report = core::simulate(fleet, request.settings, turn.stop(), executor, go_on);
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
  const auto asked = RequestContext::Clock::now();
  if (context.turn != nullptr && !context.turn->await()) {
    return stop.cancelled() ? unfinished() : too_busy(context.request_id);
  }
  const auto waited = RequestContext::Clock::now() - asked;
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
