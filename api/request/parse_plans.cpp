#include "api/request/parse_plans.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "api/json/object_reader.h"
#include "api/json/text.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

// `lower_bound` is of an answer of /v1/plan, and nobody reads it here.
constexpr std::array<std::string_view, 4> kMembers{"robot", "cost", "lower_bound", "actions"};
constexpr std::array<std::string_view, 5> kActionMembers{"type", "t_start", "t_end", "from", "to"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};

constexpr std::pair<std::string_view, core::Action::Type> kTypes[] = {
    {"rotate", core::Action::Type::rotate},
    {"translate", core::Action::Type::translate},
    {"wait", core::Action::Type::wait}};

// Any moment that is a number will do: a plan that begins before 0 is judged, not refused.
constexpr Range kMoment{-1e30, 1e30, "seconds"};

core::Pose parse_pose(const ObjectReader& action, std::string_view key, const WorldFrame& frame,
                      FaultList& faults) {
  const JsonValue* member = action.require(key);
  if (member == nullptr) return {};
  const JsonPath path = action.path(key);
  const ObjectReader reader(*member, path, kPoseMembers, faults);
  const double x = reader.require_number("x", kCoordinate).value_or(0.0);
  const double y = reader.require_number("y", kCoordinate).value_or(0.0);
  const double theta = reader.require_number("theta", kAnyAngle).value_or(0.0);
  return {frame.to_map({x, y}), core::normalize_angle(theta)};
}

core::Action parse_action(const JsonValue& value, const JsonPath& path, const WorldFrame& frame,
                          FaultList& faults) {
  core::Action action;
  const ObjectReader reader(value, path, kActionMembers, faults);
  if (const JsonValue* type = reader.require("type")) {
    action.type = read_choice(*type, reader.path("type"), kTypes, faults).value_or(action.type);
  }
  action.t_start = reader.require_number("t_start", kMoment).value_or(0.0);
  action.t_end = reader.require_number("t_end", kMoment).value_or(0.0);
  action.from = parse_pose(reader, "from", frame, faults);
  action.to = parse_pose(reader, "to", frame, faults);
  return action;
}

core::RobotPlan parse_plan(const ObjectReader& reader, const WorldFrame& frame, FaultList& faults) {
  core::RobotPlan plan;
  if (const JsonValue* actions = reader.require("actions")) {
    const JsonPath path = reader.path("actions");
    if (const JsonValue::Array* items = read_array(*actions, path, faults)) {
      plan.actions.reserve(items->size());
      for (std::size_t index = 0; index < items->size(); ++index) {
        plan.actions.push_back(parse_action((*items)[index], path / index, frame, faults));
      }
    }
  }
  plan.cost = reader.number_or("cost", kMoment, plan.actions.empty() ? 0.0 : plan.actions.back().t_end);
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
  std::optional<std::size_t> assign(const JsonValue& value, const JsonPath& path, FaultList& faults) {
    const auto id = read_name(value, path, faults);
    if (!id) return std::nullopt;
    const auto found = robots_.find(*id);
    if (found == robots_.end()) {
      faults.add(value, path, fault::kUnknownRobot, "There is no robot " + in_quotes(*id) + " in robots.");
      return std::nullopt;
    }
    if (!planned_.insert(found->second).second) {
      faults.add(value, path, fault::kDuplicate,
                 "Robot " + in_quotes(*id) + " has a plan already; give one.");
      return std::nullopt;
    }
    return found->second;
  }

 private:
  std::unordered_map<std::string, std::size_t> robots_;
  std::unordered_set<std::size_t> planned_;
};

}  // namespace

std::vector<core::RobotPlan> parse_plans(const JsonValue& value, const JsonPath& path,
                                         const std::vector<ReadRobot>& robots, const WorldFrame& frame,
                                         FaultList& faults) {
  std::vector<core::RobotPlan> plans;
  const JsonValue::Array* items = read_array(value, path, faults);
  if (items == nullptr) return plans;
  Roster roster(robots);
  for (std::size_t index = 0; index < items->size(); ++index) {
    const JsonPath plan_path = path / index;
    const ObjectReader reader((*items)[index], plan_path, kMembers, faults);
    core::RobotPlan plan = parse_plan(reader, frame, faults);
    const JsonValue* robot = reader.require("robot");
    if (robot == nullptr) continue;
    if (const auto owner = roster.assign(*robot, reader.path("robot"), faults)) {
      plan.robot = *owner;
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

}  // namespace fleetplan::api
