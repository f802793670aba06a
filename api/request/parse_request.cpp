#include "api/request/parse_request.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/errors.h"
#include "api/request/fleet/geometry_faults.h"
#include "api/request/fleet/parse_plans.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"
#include "core/map/static_map.h"
#include "core/model/problem.h"
#include "core/travel/goal_choice.h"
#include "core/verify/check_rules.h"

namespace fleetplan::api {

namespace {

struct MadeProblem {
  core::Problem problem;
  std::optional<core::OpenFleet> open;  // if any goals are open
  /// The faults of each invalid robot; empty lists for the others, or no lists at all.
  std::vector<std::vector<Fault>> errors;
};

/// The work of looking up a robot of a zone, in bytes of text.
constexpr std::size_t kWorkOfAZoneRobot = 4;

bool is_of_a_pair(const core::ProblemFault& found) {
  using Kind = core::ProblemFault::Kind;
  return found.kind != Kind::start_in_obstacle && found.kind != Kind::goal_in_obstacle &&
         found.other != found.robot;
}

/// Makes the problem, if need be again and again with more robots that are invalid.
class ProblemMaker {
 public:
  ProblemMaker(Fleet& fleet, const JsonReader& root, core::Work& work, core::MapCache* maps)
      : fleet_(fleet),
        root_(root),
        work_(work),
        map_(maps != nullptr ? maps->map_of(std::move(fleet.map->grid), work.reading())
                             : core::static_map(std::move(fleet.map->grid), work.reading())),
        reports_(reports()) {
    // A part that could not be read may be what would make committed motion valid.
    const bool poses_only = root.fault_count() > 0;
    for (std::size_t index = 0; index < fleet.robots.size(); ++index) {
      if (!fleet.robots[index].placed) continue;
      robots_.push_back(taken(fleet.robots[index], poses_only));
      open_.push_back(std::move(fleet.robots[index].open));
      any_open_ = any_open_ || !open_.back().empty();
      indices_.push_back(index);
    }
    if (reports_) errors_.resize(robots_.size());
  }

  std::optional<MadeProblem> run() {
    if (!map_) work_.look();
    while (map_) {
      core::ProblemConditions made_of = conditions();
      if (work_.met()) break;
      if (any_open_ && !choose_poses_without_search()) {
        if (reports_ && !work_.met()) continue;
        break;
      }
      auto made = core::Problem::create(map_, reports_ || any_open_ ? robots_ : std::move(robots_),
                                        std::move(made_of), work_.reading());
      if (auto* problem = std::get_if<core::Problem>(&made)) {
        return MadeProblem{std::move(*problem), open_fleet(), std::move(errors_)};
      }
      const auto& faults = std::get<core::ProblemFaults>(made);
      if (!faults.finished) work_.look();
      if (!nearest_) {
        nearest_.emplace(map_, zones(), indices_.size(), fleet_.options.plan.inflation, fleet_.map->frame,
                         work_.reading());
      }
      if (reports_ && faults.finished && mark_invalid(faults)) continue;
      report(faults);
      root_.count_more_faults(faults.total - faults.listed.size());
      return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  void report(const core::ProblemFaults& faults) {
    std::string cause = common_cause(faults, fleet_, indices_, *map_, work_.reading());
    for (const auto& found : faults.listed) {
      if (is_told_at_start(found, faults)) continue;
      const GeometryFault fault = describe(found, fleet_, indices_, map_->grid(), *nearest_);
      fault.place.fault(fault.code, fault.detail + std::exchange(cause, ""));
    }
  }

  /// Whether the fault is at a goal that a robot has only because it returns to its start, and the start has
  /// the same fault.
  bool is_told_at_start(const core::ProblemFault& found, const core::ProblemFaults& faults) const {
    using Kind = core::ProblemFault::Kind;
    const auto returns = [&](std::size_t robot) { return fleet_.robots[indices_[robot]].returns_to_start; };
    const bool is_of_pair = found.kind == Kind::goals_overlap;
    if (!is_of_pair && found.kind != Kind::goal_in_obstacle) return false;
    if (!returns(found.robot) || (is_of_pair && !returns(found.other))) return false;
    const Kind kind = is_of_pair ? Kind::starts_overlap : Kind::start_in_obstacle;
    return std::any_of(faults.listed.begin(), faults.listed.end(), [&](const core::ProblemFault& other) {
      return other.kind == kind && other.robot == found.robot && (!is_of_pair || other.other == found.other);
    });
  }

  /// Chooses the poses of open goals, as far as that takes no search. Returns whether all of them have one.
  bool choose_poses_without_search() {
    const auto without =
        core::choose_without_search(map_, zones(), fleet_.options.plan, robots_, open_, work_.reading());
    for (const core::WithoutPose& goal : without) report_open(goal);
    return without.empty() && !work_.met();
  }

  void report_open(const core::WithoutPose& goal) {
    const auto& [robot, open] = goal.place;
    const JsonReader place = fleet_.robots[indices_[robot]].goals[open_[robot][open].goal].find("any_of");
    const char* code = goal.any_fits ? fault::kGoalsOverlap : fault::kGoalInObstacle;
    const std::string detail =
        goal.any_fits
            ? "The robot would stay at one of these poses, but other robots stay at all of them that fit: "
              "give more poses, or let robots go on with \"idle\": \"yield\"."
            : "None of these poses fits: at each of them, the disk of the robot overlaps a blocked cell, a "
              "blocked zone or the edge of the map. Move one of them, or make the robot smaller.";
    if (!reports_) return place.fault(code, detail);
    make_invalid(robot, place.described_fault(code, detail));
  }

  std::optional<core::OpenFleet> open_fleet() {
    if (!any_open_) return std::nullopt;
    return core::OpenFleet{std::move(robots_), std::move(open_)};
  }

  /// Whether invalid robots are reported. A request with other faults is refused anyway.
  bool reports() const {
    return fleet_.options.invalid_robots == InvalidRobots::report && root_.fault_count() == 0;
  }

  static core::Robot taken(ParsedRobot& read, bool poses_only) {
    core::Robot robot = std::move(read.robot);
    read.robot.id = robot.id;  // id for messages
    if (!poses_only) return robot;
    robot.committed.clear();
    robot.previous.reset();
    return robot;
  }

  core::ProblemConditions conditions() {
    core::ProblemConditions conditions = core::conditions_of(fleet_.options.plan);
    conditions.list_faults_of_every_robot = reports_;
    conditions.obstacles = reports_ ? fleet_.obstacles : std::move(fleet_.obstacles);
    conditions.zones = zones();
    return conditions;
  }

  /// Returns the zones with the robots that are placed. A zone that is for none of these is for no robot.
  std::vector<core::Zone> zones() const {
    std::vector<core::Zone> zones = fleet_.zones;
    for (core::Zone& zone : zones) {
      if (work_.met_after(kWorkOfAZoneRobot * zone.robots.size())) break;
      if (zone.robots.empty()) continue;
      std::vector<std::size_t> placed;
      for (const std::size_t robot : zone.robots) {
        const auto index = std::lower_bound(indices_.begin(), indices_.end(), robot);
        if (index != indices_.end() && *index == robot) {
          placed.push_back(static_cast<std::size_t>(index - indices_.begin()));
        }
      }
      if (placed.empty()) placed.push_back(fleet_.robots.size());
      zone.robots = std::move(placed);
    }
    return zones;
  }

  /// Makes the robots at fault invalid. Returns false if all of them were invalid before.
  bool mark_invalid(const core::ProblemFaults& faults) {
    bool any = false;
    for (const core::ProblemFault& found : faults.listed) {
      if (is_told_at_start(found, faults)) continue;
      const GeometryFault fault = describe(found, fleet_, indices_, map_->grid(), *nearest_);
      if (work_.look()) return false;
      const Fault error = fault.place.described_fault(fault.code, fault.detail);
      any = make_invalid(found.robot, error) || any;
      if (is_of_a_pair(found)) any = make_invalid(found.other, error) || any;
    }
    return any;
  }

  bool make_invalid(std::size_t index, const Fault& error) {
    errors_[index].push_back(error);
    core::Robot& robot = robots_[index];
    if (robot.invalid) return false;
    robot.invalid = true;
    robot.goal.reset();
    robot.via.clear();
    robot.committed.clear();
    robot.previous.reset();
    return true;
  }

  Fleet& fleet_;
  const JsonReader& root_;
  core::Work& work_;
  std::shared_ptr<const core::StaticMap> map_;
  bool reports_;
  std::vector<core::Robot> robots_;      // the robots that are placed
  std::optional<NearestGoals> nearest_;  // once there are faults
  core::OpenGoals open_;                 // of these robots
  bool any_open_ = false;
  std::vector<std::size_t> indices_;  // index of each of these robots in the fleet
  std::vector<std::vector<Fault>> errors_;
};

/// Makes the problem of a fleet with a map. It contains the robots whose radius and start could be read; the
/// faults of other robots hide none of their faults. Takes the map, the actions, the goals and the obstacles
/// out of the fleet.
///
/// Poses in obstacles, overlapping starts or last goals, and committed motion that collides are faults. Then
/// there is no problem. There is none either if `work` is met. If invalid robots are to be reported, there is
/// a problem: they are invalid and stand at their starts. `maps`, which may be null, has the maps of earlier
/// requests.
std::optional<MadeProblem> make_problem(Fleet& fleet, const JsonReader& root, core::Work& work,
                                        core::MapCache* maps) {
  return ProblemMaker(fleet, root, work, maps).run();
}

void tell_choice(const core::OpenGoal& goal, ReceivedRobot& received) {
  if (goal.tolerance > 0.0) {
    received.places.resize(goal.goal + 1);
    received.places.back() = goal.choice().position;
  } else {
    received.choices.resize(goal.goal + 1);
    received.choices.back() = goal.choice().number;
  }
}

/// Returns what answers repeat of the robots. `errors` has the errors of each robot, or is empty.
std::vector<ReceivedRobot> received(std::vector<ParsedRobot>& robots,
                                    std::vector<std::vector<Fault>> errors) {
  std::vector<ReceivedRobot> received(robots.size());
  for (std::size_t index = 0; index < robots.size(); ++index) {
    ParsedRobot& read = robots[index];
    received[index] = {.committed = std::move(read.received_committed),
                       .previous = std::move(read.received_previous),
                       .lists_visits = read.lists_visits,
                       .errors = errors.empty() ? std::vector<Fault>{} : std::move(errors[index]),
                       .metadata = std::move(read.metadata),
                       .goal_texts = std::move(read.goal_texts)};
  }
  return received;
}

}  // namespace

std::optional<PlanRequest> parse_plan_request(const JsonReader& request, const Limits& limits,
                                              core::Work& work, core::MapCache* maps) {
  Fleet fleet = parse_fleet(request, limits, [&](const ParsedOptions& options) {
    work.set_budget(effective_budget(options, limits));
  });
  if (!fleet.map || work.met()) return std::nullopt;
  std::vector<double> body_radii;
  for (const ParsedRobot& read : fleet.robots) {
    body_radii.push_back(read.body_radius.value_or(read.robot.radius));
  }
  auto made = make_problem(fleet, request, work, maps);
  if (!made) return std::nullopt;
  std::vector<std::string> warnings = std::move(fleet.options.warnings);
  if (auto warning = budget_warning(fleet.options, limits)) warnings.push_back(std::move(*warning));
  std::vector<ReceivedRobot> repeated = received(fleet.robots, std::move(made->errors));
  PlanRequest read{.problem = std::move(made->problem),
                   .options = fleet.options.plan,
                   .budget = effective_budget(fleet.options, limits),
                   .frame = fleet.map->frame,
                   .warnings = std::move(warnings),
                   .received = std::move(repeated),
                   .metadata = std::move(fleet.metadata),
                   .dependencies = requested_dependencies(fleet),
                   .open = std::move(made->open),
                   .body_radii = std::move(body_radii)};
  if (read.open) tell_choices(read.open->goals, read.received);
  return read;
}

void tell_choices(const core::OpenGoals& open, std::vector<ReceivedRobot>& received) {
  // A request with robots that have no place is refused; there are goals of the others only.
  if (open.size() != received.size()) return;
  // Bounded: the goals of the request.
  for (std::size_t k = 0; k < received.size(); ++k) {
    for (const core::OpenGoal& goal : open[k]) tell_choice(goal, received[k]);
  }
}

Result<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits, core::Work& work,
                                                core::MapCache* maps) {
  const auto parse = [&](const JsonReader& root, core::Work& reading) {
    return parse_plan_request(root, limits, reading, maps);
  };
  return parse_body<PlanRequest>(body, limits, work, kPlanRequestMembers, parse);
}

namespace {

// Members of answers beside the plans are ignored, except `unavoidable`.
constexpr auto kValidateRequestMembers = joined(
    kFleetMembers, std::array<std::string_view, 2>{"plans", "tolerance"}, kPlanAnswerMembers, kAddedMembers);

constexpr double kDefaultTolerance = core::kMaxTolerance;  // metres, seconds, radians
constexpr double kLargestTolerance = 1e9;
constexpr Range kTolerance{0.0, kLargestTolerance, "(metres, seconds and radians)"};

/// Returns the budget of a check, at least the default budget. The options may come from the plan's request,
/// which allowed less.
std::chrono::nanoseconds check_budget(ParsedOptions options, const Limits& limits) {
  const auto least = static_cast<double>(limits.default_budget_ms);
  if (options.budget_ms) options.budget_ms = std::max(*options.budget_ms, least);
  return effective_budget(options, limits);
}

/// Returns the rules of a check. Inflation and added waits are left out, because they matter only to the
/// planner: plans are checked with bare radii.
core::CheckRules rules_of(const core::PlanOptions& options,
                          std::vector<core::UnavoidableCollision> collisions) {
  core::CheckRules rules;
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  rules.horizon = options.horizon;
  rules.exempt = std::move(collisions);
  return rules;
}

}  // namespace

Result<ValidateRequest, RequestError> parse_validate_request(std::string_view body, const Limits& limits,
                                                             core::Work& work) {
  const auto parse = [&](const JsonReader& root, core::Work& reading) -> std::optional<ValidateRequest> {
    Fleet fleet = parse_fleet(root, limits, [&](const ParsedOptions& options) {
      reading.set_budget(check_budget(options, limits));
    });
    const double tolerance = root.find("tolerance").number(kTolerance).value_or(kDefaultTolerance);
    const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
    auto plans = parse_plans(root.require("plans"), fleet.robots, frame);
    auto collisions = parse_unavoidable(root.find("unavoidable"), fleet);
    if (!fleet.map || reading.met()) return std::nullopt;
    RequestedDependencies dependencies = requested_dependencies(fleet);
    std::vector<core::Robot> robots;
    robots.reserve(fleet.robots.size());
    for (ParsedRobot& robot : fleet.robots) robots.push_back(std::move(robot.robot));
    if (fleet.options.invalid_robots == InvalidRobots::report) {
      mark_invalid_robots(root.find("unplanned"), robots);
    }
    core::CheckRules rules = rules_of(fleet.options.plan, std::move(collisions));
    rules.tolerances.assign(robots.size(), core::Tolerance::of_all(tolerance));
    return ValidateRequest{.grid = std::move(fleet.map->grid),
                           .robots = std::move(robots),
                           .obstacles = std::move(fleet.obstacles),
                           .zones = std::move(fleet.zones),
                           .plans = std::move(plans),
                           .dependencies = std::move(dependencies),
                           .rules = std::move(rules),
                           .budget = check_budget(fleet.options, limits)};
  };
  return parse_body<ValidateRequest>(body, limits, work, kValidateRequestMembers, parse);
}

}  // namespace fleetplan::api
