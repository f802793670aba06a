#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "api/execution/execution_requests.h"
#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/request/fleet/parse_actions.h"
#include "api/request/fleet/parse_plans.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"
#include "api/request/shared_members.h"
#include "api/response/write_response.h"
#include "core/execution/simulation/disturbance.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 5> kDisturbanceMembers{"speed", "turn", "stops", "start_delay",
                                                              "cross_track"};
constexpr std::array<std::string_view, 2> kRangeMembers{"min", "max"};
constexpr std::array<std::string_view, 2> kStopsMembers{"rate_per_hour", "mean_s"};
constexpr std::array<std::string_view, 2> kCrossTrackMembers{"sigma", "correlation_length"};

constexpr Range kFactor{1e-3, 1e3, "times the planned speed"};
constexpr double kLongestDelay = 1e6;  // seconds, eleven days
constexpr Range kDelay{0.0, kLongestDelay, "seconds"};
/// The range of the rate of stops: more than ten a second would not let a robot move.
constexpr Range kStopsRate{0.0, 36'000.0, "stops in an hour of motion"};

core::UniformRange parse_range(const JsonReader& member, const Range& allowed,
                               const core::UniformRange& absent) {
  const JsonReader json = member.object(kRangeMembers);
  if (!json) return absent;
  const auto min = json.require("min").number(allowed);
  const auto max = json.require("max").number(allowed);
  if (!min || !max) return absent;
  if (*max < *min) {
    json.find("max").fault(fault::kOutOfRange, "max is " + number_text(*max) + ", less than min, " +
                                                   number_text(*min) + "; it must be at least min.");
  }
  return {*min, *max};
}

core::Disturbance::Stops parse_stops(const JsonReader& member) {
  const JsonReader json = member.object(kStopsMembers);
  if (!json) return {};
  return {json.require("rate_per_hour").number(kStopsRate).value_or(0.0),
          json.require("mean_s").number(kDelay).value_or(0.0)};
}

core::Disturbance::CrossTrack parse_cross_track(const JsonReader& member) {
  const JsonReader json = member.object(kCrossTrackMembers);
  if (!json) return {};
  return {json.require("sigma").number(kLengthOrZero).value_or(0.0),
          json.require("correlation_length").number(kLength).value_or(1.0)};
}

/// Reads the member `disturbance` of a request to simulate. Missing members disturb nothing.
core::Disturbance parse_disturbance(const JsonReader& member) {
  core::Disturbance disturbance;
  const JsonReader json = member.object(kDisturbanceMembers);
  if (!json) return disturbance;
  disturbance.speed = parse_range(json.find("speed"), kFactor, disturbance.speed);
  disturbance.turn = parse_range(json.find("turn"), kFactor, disturbance.turn);
  disturbance.stops = parse_stops(json.find("stops"));
  disturbance.start_delay = parse_range(json.find("start_delay"), kDelay, disturbance.start_delay);
  disturbance.cross_track = parse_cross_track(json.find("cross_track"));
  return disturbance;
}

// In the order of core::ExecutionPolicy.
constexpr std::array<std::string_view, 4> kPolicies{"open_loop", "absorb_waits", "dependencies",
                                                    "clock_stop"};

}  // namespace

std::string_view name_of(core::ExecutionPolicy policy) { return kPolicies[static_cast<std::size_t>(policy)]; }

RequestedExecution parse_execution(const JsonReader& root, std::vector<std::string>& warnings) {
  RequestedExecution execution;
  const JsonReader policy =
      root.require("policy", "; give \"open_loop\", \"absorb_waits\", \"dependencies\" or \"clock_stop\"");
  if (const auto word = policy.word(kPolicies)) execution.policy = static_cast<core::ExecutionPolicy>(*word);
  const JsonReader max_delay = root.find("max_delay");
  execution.max_delay = max_delay.number(kDuration).value_or(0.0);
  const bool has_clock = execution.policy == core::ExecutionPolicy::clock_stop;
  if (has_clock) root.require("max_delay", "; the policy \"clock_stop\" needs it: seconds");
  if (max_delay && !has_clock) {
    warnings.emplace_back("max_delay has no effect: it belongs to the policy \"clock_stop\".");
  }
  execution.disturbance = parse_disturbance(root.find("disturbance"));
  return execution;
}

namespace {

// What answers have beside the plans is ignored, but for `dependencies`.
constexpr std::array<std::string_view, 7> kSimulationMembers{"plans", "policy", "max_delay", "disturbance",
                                                             "runs",  "seed",   "trace"};
constexpr auto kSimulateRequestMembers =
    joined(kFleetMembers, kSimulationMembers, kPlanAnswerMembers, kAddedMembers);

constexpr std::size_t kDefaultRuns = 100;
constexpr std::uint64_t kMaxSimulationSeed = std::numeric_limits<std::uint64_t>::max();  // like the options'

/// Removes the gaps within the tolerance between the actions of each plan, and reports larger gaps.
void join_actions(const JsonReader& member, const std::vector<core::Robot>& robots,
                  std::vector<core::RobotPlan>& plans) {
  auto plan = plans.begin();
  // Bounded: items are read until the Work ends.
  for (const JsonReader item : member.array().items()) {
    const core::Robot& robot = robots[plan->robot];
    ActionChain chain({robot, robot.start, std::nullopt, std::nullopt});
    auto action = plan->actions.begin();
    for (const JsonReader part : item.find("actions").array().items()) {
      *action = chain.append(*action, part);
      ++action;
    }
    plan->cost = plan->actions.empty() ? 0.0 : plan->actions.back().t_end;
    ++plan;
  }
}

void parse_all_dependencies(const JsonReader& root, SimulateRequest& request) {
  const JsonReader member = root.find("dependencies");
  const bool is_given = member && !member.is_null();
  if (request.policy == core::ExecutionPolicy::dependencies && !is_given) {
    root.require("dependencies", "; POST /v1/dependencies makes them for a plan");
    if (member) member.must_be(fault::kWrongType, "an array; POST /v1/dependencies makes one for a plan");
  }
  if (is_given) request.dependencies = parse_dependencies(member, request.robots, request.plans);
}

/// Reads `runs`, `seed` and `trace`. Runs are limited if their figures would take more than a quarter of the
/// memory.
void parse_runs(const JsonReader& root, const Limits& limits, SimulateRequest& request) {
  constexpr Range kRuns{1.0, static_cast<double>(kMaxRuns), "runs"};
  const JsonReader member = root.find("runs");
  std::size_t runs = kDefaultRuns;
  if (member.number(kRuns)) runs = member.natural(kMaxRuns).value_or(runs);
  request.settings.seed = root.find("seed").natural(kMaxSimulationSeed).value_or(0);
  const JsonReader trace = root.find("trace");
  if (const auto run = trace.natural(kMaxRuns)) {
    if (*run >= runs) {
      trace.fault(fault::kOutOfRange, "There is no run " + std::to_string(*run) + " of " +
                                          std::to_string(runs) + "; runs are counted from 0.");
    }
    request.trace = *run;
  }
  const std::size_t figures = (request.plans.size() + 2) * sizeof(double);
  const std::size_t max_runs = std::max<std::size_t>(1, limits.max_plan_memory / 4 / figures);
  if (runs > max_runs) {
    request.warnings.push_back("runs was reduced from " + std::to_string(runs) + " to " +
                               std::to_string(max_runs) + ": more figures of " +
                               std::to_string(request.plans.size()) +
                               " plans do not fit in max_plan_memory of /v1/limits.");
  }
  request.settings.runs = std::min(runs, max_runs);
}

void take_fleet(Fleet& fleet, const Limits& limits, SimulateRequest& request) {
  request.wait_before_move = fleet.options.plan.wait_before_move;
  request.budget = effective_budget(fleet.options, limits);
  if (auto warning = budget_warning(fleet.options, limits)) request.warnings.push_back(std::move(*warning));
  if (!fleet.obstacles.empty()) {
    request.warnings.emplace_back(
        "Moving obstacles are not simulated: figures are of robots and walls only.");
  }
  for (ParsedRobot& read : fleet.robots) {
    request.body_radii.push_back(read.body_radius.value_or(read.robot.radius));
    request.robots.push_back(std::move(read.robot));
  }
}

}  // namespace

Result<SimulateRequest, RequestError> parse_simulate_request(std::string_view body, const Limits& limits,
                                                             core::Work& work) {
  const auto parse = [&](const JsonReader& root, core::Work& reading) -> std::optional<SimulateRequest> {
    Fleet fleet = parse_fleet(root, limits, [&](const ParsedOptions& options) {
      reading.set_budget(effective_budget(options, limits));
    });
    const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
    const JsonReader list = root.require("plans");
    auto plans = parse_plans(list, fleet.robots, frame);
    if (!fleet.map || reading.met()) return std::nullopt;
    SimulateRequest request{.grid = std::move(fleet.map->grid),
                            .frame = frame,
                            .robots = {},
                            .plans = std::move(plans),
                            .body_radii = {}};
    const RequestedExecution execution = parse_execution(root, request.warnings);
    request.policy = execution.policy;
    request.max_delay = execution.max_delay;
    parse_runs(root, limits, request);
    request.settings.disturbance = execution.disturbance;
    take_fleet(fleet, limits, request);
    if (fleet.options.invalid_robots == InvalidRobots::report) {
      mark_invalid_robots(root.find("unplanned"), request.robots);
    }
    if (root.fault_count() == 0) join_actions(list, request.robots, request.plans);
    core::add_commitments(request.robots, request.plans);
    parse_all_dependencies(root, request);
    return reading.met() ? std::nullopt : std::optional(std::move(request));
  };
  return parse_body<SimulateRequest>(body, limits, work, kSimulateRequestMembers, parse);
}

namespace {

struct Quantile {
  std::string_view name;
  double share;
};
constexpr std::array<Quantile, 6> kQuantiles{
    {{"min", 0.0}, {"p10", 0.1}, {"p50", 0.5}, {"p90", 0.9}, {"p99", 0.99}, {"max", 1.0}}};

/// Writes the mean and the quantiles; null if there are no values. A quantile is the smallest value that is
/// not exceeded in that share of the runs.
void write_distribution(JsonWriter& json, std::string_view name, std::vector<double> values) {
  json.key(name);
  if (values.empty()) {
    json.value(std::optional<double>());
    return;
  }
  const auto count = static_cast<double>(values.size());
  json.begin_object();
  json.member("mean", std::accumulate(values.begin(), values.end(), 0.0) / count);
  auto sorted_until = values.begin();
  for (const Quantile& quantile : kQuantiles) {
    const double rank = std::max(1.0, std::ceil(quantile.share * count));
    const auto place = values.begin() + (static_cast<std::ptrdiff_t>(rank) - 1);
    std::nth_element(sorted_until, place, values.end());
    json.member(quantile.name, *place);
    sorted_until = place;
  }
  json.end_object();
}

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

class SimulationWriter {
 public:
  SimulationWriter(const core::SimulationReport& report, const SimulateRequest& request)
      : report_(report), request_(request) {}

  std::string write(const std::optional<std::string>& trace, const std::string& request_id) {
    const core::SimulationProgress& totals = report_.totals;
    json_.begin_object();
    json_.member("request_id", request_id).member("runs", totals.done);
    json_.member("collision_share", share(totals.collided, totals.done));
    json_.member("deadlock_share", share(totals.deadlocked, totals.done));
    write_planned();
    write_distribution(json_, "flowtime", report_.flowtimes);
    write_distribution(json_, "makespan", report_.makespans);
    write_robots();
    write_collisions();
    write_pairs();
    write_deadlocks();
    if (trace) json_.key("trace").json(*trace);
    json_.key("warnings").begin_array();
    for (const std::string& warning : request_.warnings) json_.value(std::string_view(warning));
    json_.end_array().end_object();
    return json_.take();
  }

 private:
  std::string_view id(std::size_t robot) const { return request_.robots[robot].id; }

  void write_planned() {
    double flowtime = 0.0;
    double makespan = 0.0;
    for (const core::RobotPlan& plan : request_.plans) {
      flowtime += plan.cost;
      makespan = std::max(makespan, plan.cost);
    }
    json_.key("planned").begin_object();
    json_.member("flowtime", flowtime).member("makespan", makespan).end_object();
  }

  void write_robots() {
    json_.key("robots").begin_array();
    for (std::size_t k = 0; k < request_.plans.size(); ++k) {
      const core::RobotPlan& plan = request_.plans[k];
      json_.begin_object().member("robot", id(plan.robot)).member("planned", plan.cost);
      write_distribution(json_, "delay", report_.delays[k]);
      json_.end_object();
    }
    json_.end_array();
  }

  void write_collisions() {
    json_.key("first_collisions").begin_array();
    for (const core::SimulationReport::Numbered& numbered : report_.first_collisions) {
      const core::ExecutedCollision& collision = numbered.collision;
      const core::Position where = request_.frame.to_world(collision.position);
      json_.begin_object().member("run", numbered.run);
      json_.member("with", collision.second ? "robot" : "wall");
      json_.key("robots").begin_array().value(id(collision.first));
      if (collision.second) json_.value(id(*collision.second));
      json_.end_array();
      json_.member("t", collision.t).member("x", where.x()).member("y", where.y());
      json_.member("depth", collision.depth).end_object();
    }
    json_.end_array();
  }

  void write_pairs() {
    json_.key("pairs").begin_array();
    for (const core::SimulationReport::Pair& pair : report_.pairs) {
      json_.begin_object();
      json_.key("robots").begin_array().value(id(pair.first)).value(id(pair.second)).end_array();
      json_.member("runs", pair.runs).member("share", share(pair.runs, report_.totals.done));
      json_.end_object();
    }
    json_.end_array();
  }

  void write_deadlocks() {
    json_.key("deadlocks").begin_array();
    // Bounded: at most SimulationReport::kMaxListed runs.
    for (const core::SimulationReport::Deadlock& deadlock : report_.deadlocks) {
      json_.begin_object().member("run", deadlock.run);
      json_.key("robots").begin_array();
      for (const std::size_t plan : deadlock.plans) json_.value(id(request_.plans[plan].robot));
      json_.end_array().end_object();
    }
    json_.end_array();
  }

  const core::SimulationReport& report_;
  const SimulateRequest& request_;
  JsonWriter json_;
};

}  // namespace

std::optional<std::string> write_trace(const core::SimulationTrace& trace, const SimulateRequest& request,
                                       const core::StopCondition& stop) {
  JsonWriter json;
  json.begin_object().member("run", *request.trace).key("plans").begin_array();
  for (std::size_t k = 0; k < request.plans.size(); ++k) {
    if (stop.met()) return std::nullopt;
    const core::Robot& robot = request.robots[request.plans[k].robot];
    const std::vector<core::Action>& actions = trace.actions[k];
    json.begin_object().member("robot", robot.id);
    json.member("cost", actions.empty() ? 0.0 : actions.back().t_end);
    if (!write_actions(json, actions, robot, {}, request.frame.origin, &stop)) return std::nullopt;
    json.end_object();
  }
  json.end_array().end_object();
  return json.take();
}

std::string write_simulation(const core::SimulationReport& report, const SimulateRequest& request,
                             const std::optional<std::string>& trace, const std::string& request_id) {
  return SimulationWriter(report, request).write(trace, request_id);
}

}  // namespace fleetplan::api
