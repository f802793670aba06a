#include "api/request/parse_plans.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "api/json/fault_text.h"
#include "api/request/ranges.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

// `lower_bound` belongs to an answer of /v1/plan and is ignored.
constexpr std::array<std::string_view, 4> kMembers{"robot", "cost", "lower_bound", "actions"};
constexpr std::array<std::string_view, 5> kActionMembers{"type", "t_start", "t_end", "from", "to"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};
constexpr std::array<std::string_view, 3> kTypes{"rotate", "translate", "wait"};  // as in core::Action::Type

// A plan that begins before 0 is a violation to report, not a fault of the request.
constexpr Range kTime{-kLongestTime, kLongestTime, "seconds"};

core::Pose parse_pose(const JsonReader& member, const WorldFrame& frame) {
  const JsonReader pose = member.object(kPoseMembers);
  const double x = pose.require("x").number(kCoordinate).value_or(0.0);
  const double y = pose.require("y").number(kCoordinate).value_or(0.0);
  const double theta = pose.require("theta").number(kAnyAngle).value_or(0.0);
  return {frame.to_map({x, y}), core::normalize_angle(theta)};
}

core::Action parse_action(const JsonReader& item, const WorldFrame& frame) {
  const JsonReader json = item.object(kActionMembers);
  core::Action action;
  if (const auto type = json.require("type").word(kTypes)) {
    action.type = static_cast<core::Action::Type>(*type);
  }
  action.t_start = json.require("t_start").number(kTime).value_or(0.0);
  action.t_end = json.require("t_end").number(kTime).value_or(0.0);
  action.from = parse_pose(json.require("from"), frame);
  action.to = parse_pose(json.require("to"), frame);
  return action;
}

core::RobotPlan parse_plan(const JsonReader& json, const WorldFrame& frame) {
  core::RobotPlan plan;
  const JsonReader actions = json.require("actions").array();
  const std::size_t before = json.fault_count();
  for (const JsonReader item : actions.items()) {
    const core::Action action = parse_action(item, frame);
    // After the first fault only faults matter: items may be many more than actions of that size.
    if (json.fault_count() == before) plan.actions.push_back(action);
  }
  const double end = plan.actions.empty() ? 0.0 : plan.actions.back().t_end;
  plan.cost = json.find("cost").number(kTime).value_or(end);
  return plan;
}

/// The robots by id, and which of them have a plan already.
class Roster {
 public:
  explicit Roster(const std::vector<ReadRobot>& robots) {
    for (std::size_t index = 0; index < robots.size(); ++index)
      robots_.emplace(robots[index].robot.id, index);
  }

  /// The index of the robot that a plan is for, if there is one that has no plan yet.
  std::optional<std::size_t> assign(const JsonReader& robot) {
    const auto id = robot.name();
    if (!id) return std::nullopt;
    const auto found = robots_.find(*id);
    if (found == robots_.end()) {
      robot.fault(fault::kUnknownRobot,
                  [&] { return "There is no robot " + in_quotes(*id) + " in robots."; });
      return std::nullopt;
    }
    if (!planned_.insert(found->second).second) {
      robot.fault(fault::kDuplicate,
                  [&] { return "Robot " + in_quotes(*id) + " already has a plan; give only one."; });
      return std::nullopt;
    }
    return found->second;
  }

 private:
  std::unordered_map<std::string, std::size_t> robots_;
  std::unordered_set<std::size_t> planned_;
};

}  // namespace

std::vector<core::RobotPlan> parse_plans(const JsonReader& member, const std::vector<ReadRobot>& robots,
                                         const WorldFrame& frame) {
  std::vector<core::RobotPlan> plans;
  Roster roster(robots);
  for (const JsonReader item : member.array().items()) {
    const JsonReader json = item.object(kMembers);
    core::RobotPlan plan = parse_plan(json, frame);
    if (const auto owner = roster.assign(json.require("robot"))) {
      plan.robot = *owner;
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

}  // namespace fleetplan::api
