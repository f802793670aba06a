#include "api/request/fleet/parse_plans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "api/json/errors.h"
#include "api/request/fleet/parse_actions.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/segment.h"

namespace fleetplan::api {

namespace {

// All but `robot`, `cost`, `actions` and `visits` belong to an answer of /v1/plan and are ignored.
constexpr std::array<std::string_view, 12> kPlanMembers{
    "robot", "cost",       "lower_bound",      "estimated_cost", "ends_at",  "actions",
    "stuck", "blocked_by", "blocked_by_total", "visits",         "metadata", "lattice_spacing"};
constexpr std::array<std::string_view, 11> kVisitMembers{
    "goal",   "t_arrive", "t_leave", "late_by", "estimated_t_arrive", "choice", "place",
    "reason", "zone",     "actions", "metadata"};

// A plan that begins before 0 is a violation to report, not a fault of the request.
constexpr Range kPlanTime{-kLongestTime, kLongestTime, "seconds"};

/// None for a goal that the plan does not reach.
std::optional<core::Visit> parse_visit(const JsonReader& item) {
  const JsonReader json = item.object(kVisitMembers);
  core::Visit visit;
  visit.goal = json.require("goal").natural(kGreatestIndex).value_or(0);
  const JsonReader arrives = json.require("t_arrive", "; give null for a goal that the plan does not reach");
  if (!arrives.is_null()) visit.t_arrive = arrives.number(kPlanTime).value_or(0.0);
  const JsonReader leaves = json.require("t_leave", "; give null for the last goal");
  visit.t_leave = leaves.is_null() ? core::kForever : leaves.number(kPlanTime).value_or(0.0);
  return arrives.is_null() ? std::nullopt : std::optional(visit);
}

/// Reads the pose that a visit names, or null, for a robot whose goal is open.
void parse_choice(const JsonReader& member, const JsonReader& item, ParsedRobot& read) {
  if (member.is_null()) return;
  const auto number = member.natural(kGreatestIndex);
  const auto goal = item.find("goal").natural();
  if (!number || !goal) return;
  core::OpenGoal* open = core::find_open(read.open, *goal);
  if (open == nullptr || open->tolerance > 0.0) {
    return member.fault(fault::kOutOfRange, [&] {
      return "Goal " + std::to_string(*goal) + " of robot " + in_quotes(read.robot.id) +
             " has no any_of; leave choice out.";
    });
  }
  if (*number >= open->poses.size()) {
    return member.fault(fault::kOutOfRange, [&] {
      return "any_of of goal " + std::to_string(*goal) + " has " + std::to_string(open->poses.size()) +
             " poses, numbered from 0.";
    });
  }
  core::choose(read.robot, *open, *number);
  open->is_settled = true;
}

/// Reads the place that a visit names, or null, for a robot whose goal has a tolerance.
void parse_place_of_visit(const JsonReader& member, const JsonReader& item, const WorldFrame& frame,
                          ParsedRobot& read) {
  const auto goal = item.find("goal").natural();
  if (member.is_null() || !goal) return;
  core::OpenGoal* open = core::find_open(read.open, *goal);
  if (open == nullptr || open->tolerance == 0.0) {
    return member.fault(fault::kOutOfRange, [&] {
      return "Goal " + std::to_string(*goal) + " of robot " + in_quotes(read.robot.id) +
             " has no tolerance; leave place out.";
    });
  }
  parse_place(member, frame, *open);
  core::choose(read.robot, *open, open->chosen);
  open->is_settled = true;
}

/// Settles what is open by the visits of the plan or, if they say nothing of it, by its actions.
void settle_choices(const JsonReader& json, const core::RobotPlan& plan, const WorldFrame& frame,
                    ParsedRobot& read) {
  bool is_told = false;
  for (const JsonReader item : json.find("visits").items()) {
    const JsonReader choice = item.find("choice");
    const JsonReader place = item.find("place");
    if (choice) parse_choice(choice, item, read);
    if (place) parse_place_of_visit(place, item, frame, read);
    is_told = is_told || choice || place;
  }
  if (read.open.empty()) return;
  if (is_told) return core::choose_unserved(read.robot, read.open, plan.actions, json.work().reading());
  // In the request, a choice is about the robot's own actions.
  for (core::OpenGoal& open : read.open) open.is_told = false;
  core::settle_by_actions(read.robot, read.open, plan.actions, true, json.work().reading());
}

/// The first goal that is without times in the visits of a plan.
std::optional<std::size_t> find_unserved(const JsonReader& visits) {
  for (const JsonReader visit : visits.items()) {
    if (visit.find("t_arrive").is_null()) return visit.find("goal").natural();
  }
  return std::nullopt;
}

core::RobotPlan parse_plan(const JsonReader& json, const WorldFrame& frame) {
  core::RobotPlan plan;
  const JsonReader actions = json.require("actions").array();
  const std::size_t before = json.fault_count();
  for (const JsonReader item : actions.items()) {
    const core::Action action = to_map(parse_action(item, kPlanTime), frame);
    // After the first fault only faults matter: items may be many more than actions of that size.
    if (json.fault_count() == before) plan.actions.push_back(action);
  }
  const double end = plan.actions.empty() ? 0.0 : plan.actions.back().t_end;
  plan.cost = json.find("cost").number(kPlanTime).value_or(end);
  for (const JsonReader item : json.find("visits").array().items()) {
    const std::optional<core::Visit> visit = parse_visit(item);
    if (visit && json.fault_count() == before) plan.visits.push_back(*visit);
  }
  return plan;
}

/// The robots by id, and which of them have a plan already.
class Roster {
 public:
  explicit Roster(const std::vector<ParsedRobot>& robots) : names_(robots) {}

  /// Returns the index of the robot that a plan is for. It is a fault if the robot does not exist or already
  /// has a plan; then returns none.
  std::optional<std::size_t> assign(const JsonReader& robot) {
    const auto index = names_.find(robot);
    if (!index) return std::nullopt;
    if (!planned_.insert(*index).second) {
      robot.fault(fault::kDuplicate, [&] {
        return "Robot " + in_quotes(*robot.string()) + " already has a plan; give only one.";
      });
      return std::nullopt;
    }
    return index;
  }

 private:
  RobotNames names_;
  std::unordered_set<std::size_t> planned_;
};

}  // namespace

std::vector<core::RobotPlan> parse_plans(const JsonReader& member, std::vector<ParsedRobot>& robots,
                                         const WorldFrame& frame) {
  std::vector<core::RobotPlan> plans;
  std::vector<bool> is_planned(robots.size(), false);
  Roster roster(robots);
  for (const JsonReader item : member.array().items()) {
    const JsonReader json = item.object(kPlanMembers);
    core::RobotPlan plan = parse_plan(json, frame);
    if (const auto owner = roster.assign(json.require("robot"))) {
      plan.robot = *owner;
      is_planned[*owner] = true;
      robots[*owner].first_unserved = find_unserved(json.find("visits"));
      settle_choices(json, plan, frame, robots[*owner]);
      core::set_inertia(plan.actions, robots[*owner].robot);
      plans.push_back(std::move(plan));
    }
  }
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (is_planned[k] || robots[k].open.empty()) continue;
    core::settle_by_actions(robots[k].robot, robots[k].open, robots[k].robot.committed, false,
                            member.work().reading());
  }
  return plans;
}

void check_profiles(const JsonReader& list, const std::vector<core::RobotPlan>& plans) {
  if (list.fault_count() > 0) return;
  auto plan = plans.begin();
  // Bounded: the items that were read.
  for (const JsonReader item : list.items()) {
    if (plan == plans.end()) return;
    auto action = plan->actions.begin();
    for (const JsonReader entry : item.find("actions").items()) {
      if (action == plan->actions.end()) break;
      if (action->profile && !core::profile_fits(*action)) {
        entry.find("profile").fault(fault::kProfile,
                                    "With the accelerations that the robot has during this action, the "
                                    "profile does not lead over its "
                                    "length, or angle, in its time. Send the plan with the request that it "
                                    "was made for, or leave the "
                                    "profile out for measured motion.");
      }
      ++action;
    }
    ++plan;
  }
}

namespace {

constexpr std::array<std::string_view, 3> kDependencyMembers{"gate", "until", "slack"};
constexpr std::array<std::string_view, 3> kProgressMembers{"robot", "action", "progress"};
constexpr Range kSlack{-kLongestTime, kLongestTime, "seconds"};

/// Seconds by which a slack may be off that went through decimal text, or was made for rounded times.
constexpr double kSameSlack = 1e-6;

class DependencyReader {
 public:
  DependencyReader(const std::vector<core::Robot>& robots, const std::vector<core::RobotPlan>& plans)
      : actions_(core::executed_actions(robots, plans)), names_(robots) {}

  std::optional<core::Dependency> read(const JsonReader& item) const {
    const JsonReader json = item.object(kDependencyMembers);
    const JsonReader gate_member = json.require("gate");
    const JsonReader until_member = json.require("until");
    const auto gate = read_progress(gate_member);
    const auto until = read_progress(until_member);
    const JsonReader slack_member = json.find("slack");
    const auto slack = slack_member.number(kSlack);
    if (!gate || !until) return std::nullopt;
    if (gate->robot == until->robot) {
      until_member.find("robot").fault(
          fault::kDependency, "gate and until are of the same robot; a robot depends on others only.");
      return std::nullopt;
    }
    const double planned = time_of(*gate) - time_of(*until);
    if (planned <= 0.0) {
      item.fault(fault::kDependency, [&] {
        return "By the plans, the gate is passed at " + number_text(time_of(*gate)) +
               " s, not after until, which is reached at " + number_text(time_of(*until)) +
               " s: the dependencies belong to other plans; send those made for these.";
      });
    } else if (slack && std::abs(*slack - planned) > kSameSlack) {
      slack_member.fault(fault::kDependency, [&] {
        return "By the plans, the slack is " + number_text(planned) + " s, not " + number_text(*slack) +
               " s: the dependencies belong to other plans; send those made for these.";
      });
    }
    return core::Dependency{*gate, *until, planned};
  }

 private:
  double time_of(const core::ActionProgress& progress) const {
    return core::planned_time(actions_[progress.robot], progress.action, progress.fraction);
  }

  std::optional<core::ActionProgress> read_progress(const JsonReader& member) const {
    const JsonReader json = member.object(kProgressMembers);
    const JsonReader robot_member = json.require("robot");
    const JsonReader action_member = json.require("action");
    const auto robot = names_.find(robot_member);
    const auto action = action_member.natural(kGreatestIndex);
    const auto fraction = json.require("progress").number(kFraction);
    if (!robot || !action || !fraction) return std::nullopt;
    const std::size_t count = actions_[*robot].size();
    if (*action >= count) {
      action_member.fault(fault::kDependency, [&] {
        return "Robot " + in_quotes(*robot_member.string()) + " has " + std::to_string(count) +
               " actions, numbered from 0: the dependencies belong to other plans; send those made for "
               "these.";
      });
      return std::nullopt;
    }
    return core::ActionProgress{*robot, *action, *fraction};
  }

  std::vector<core::Actions> actions_;
  RobotNames names_;
};

}  // namespace

std::vector<core::Dependency> parse_dependencies(const JsonReader& member,
                                                 const std::vector<core::Robot>& robots,
                                                 const std::vector<core::RobotPlan>& plans) {
  std::vector<core::Dependency> dependencies;
  if (!member) return dependencies;
  const DependencyReader reader(robots, plans);
  const std::size_t before = member.fault_count();
  for (const JsonReader item : member.array().items()) {
    const auto dependency = reader.read(item);
    // After the first fault only faults matter.
    if (dependency && member.fault_count() == before) dependencies.push_back(*dependency);
  }
  return dependencies;
}

namespace {

constexpr std::array<std::string_view, 4> kUnavoidableMembers{"robots", "robot", "obstacle", "t"};

/// Robots or obstacles by id.
using Names = std::unordered_map<std::string_view, std::size_t>;

/// Returns the index of the robot or obstacle with the id in `member`, which may be absent.
std::optional<std::size_t> find(const JsonReader& member, const Names& names, const char* code,
                                const char* kind) {
  const auto id = member.name();
  if (!id) return std::nullopt;
  const auto found = names.find(*id);
  if (found != names.end()) return found->second;
  member.fault(code, [&] { return std::string("There is no ") + kind + ' ' + in_quotes(*id) + "."; });
  return std::nullopt;
}

class UnavoidableReader {
 public:
  explicit UnavoidableReader(const Fleet& fleet) {
    for (std::size_t k = 0; k < fleet.robots.size(); ++k) robots_.emplace(fleet.robots[k].robot.id, k);
    for (std::size_t k = 0; k < fleet.obstacles.size(); ++k) obstacles_.emplace(fleet.obstacles[k].id, k);
  }

  core::UnavoidableCollision read(const JsonReader& item) const {
    const JsonReader json = item.object(kUnavoidableMembers);
    core::UnavoidableCollision collision;
    collision.t = json.require("t").number(kDuration).value_or(0.0);
    if (const JsonReader pair = json.find("robots")) {
      read_pair(pair, collision);
      return collision;
    }
    collision.robot = robot(json.require("robot", "; give it with \"obstacle\", or \"robots\"")).value_or(0);
    collision.obstacle = find(json.require("obstacle"), obstacles_, fault::kUnknownObstacle, "obstacle");
    return collision;
  }

 private:
  std::optional<std::size_t> robot(const JsonReader& member) const {
    return find(member, robots_, fault::kUnknownRobot, "robot");
  }

  void read_pair(const JsonReader& member, core::UnavoidableCollision& collision) const {
    const JsonReader pair = member.array();
    if (pair && pair.size() != 2) pair.fault(fault::kOutOfRange, "robots must be the ids of two robots.");
    if (!pair || pair.size() != 2) return;
    collision.robot = robot(pair.item(0)).value_or(0);
    collision.other = robot(pair.item(1));
  }

  Names robots_;
  Names obstacles_;
};

}  // namespace

std::vector<core::UnavoidableCollision> parse_unavoidable(const JsonReader& member, const Fleet& fleet) {
  std::vector<core::UnavoidableCollision> collisions;
  if (!member) return collisions;
  const UnavoidableReader reader(fleet);
  const std::size_t before = member.fault_count();
  for (const JsonReader item : member.array().items()) {
    const core::UnavoidableCollision collision = reader.read(item);
    if (member.fault_count() == before) collisions.push_back(collision);
  }
  return collisions;
}

void mark_invalid_robots(const JsonReader& unplanned, std::vector<core::Robot>& robots) {
  Names names;
  for (std::size_t k = 0; k < robots.size(); ++k) names.emplace(robots[k].id, k);
  for (const JsonReader item : unplanned.items()) {
    if (item.find("reason").string() != std::string_view("invalid")) continue;
    const auto found = names.find(item.find("robot").string().value_or(""));
    if (found == names.end()) continue;
    core::Robot& robot = robots[found->second];
    robot.invalid = true;
    robot.committed.clear();
  }
}

}  // namespace fleetplan::api
