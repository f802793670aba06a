#include "api/request/parse_plans.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "api/json/faults.h"
#include "api/request/motion/parse_actions.h"
#include "api/request/ranges.h"
#include "api/request/robot_names.h"
#include "core/geometry/segment.h"

namespace fleetplan::api {

namespace {

// `lower_bound`, `estimated_cost`, `ends_at` and `metadata` belong to an answer of /v1/plan and are ignored.
constexpr std::array<std::string_view, 8> kPlanMembers{"robot",   "cost",    "lower_bound", "estimated_cost",
                                                       "ends_at", "actions", "visits",      "metadata"};
constexpr std::array<std::string_view, 4> kVisitMembers{"goal", "t_arrive", "t_leave", "metadata"};

// A plan that begins before 0 is a violation to report, not a fault of the request.
constexpr Range kTime{-kLongestTime, kLongestTime, "seconds"};

core::Visit parse_visit(const JsonReader& item) {
  const JsonReader json = item.object(kVisitMembers);
  core::Visit visit;
  visit.goal = json.require("goal").natural(kGreatestIndex).value_or(0);
  visit.t_arrive = json.require("t_arrive").number(kTime).value_or(0.0);
  const JsonReader leaves = json.require("t_leave", "; give null for the last goal");
  visit.t_leave = leaves.is_null() ? core::kForever : leaves.number(kTime).value_or(0.0);
  return visit;
}

core::RobotPlan parse_plan(const JsonReader& json, const WorldFrame& frame) {
  core::RobotPlan plan;
  const JsonReader actions = json.require("actions").array();
  const std::size_t before = json.fault_count();
  for (const JsonReader item : actions.items()) {
    const core::Action action = to_map(parse_action(item, kTime), frame);
    // After the first fault only faults matter: items may be many more than actions of that size.
    if (json.fault_count() == before) plan.actions.push_back(action);
  }
  const double end = plan.actions.empty() ? 0.0 : plan.actions.back().t_end;
  plan.cost = json.find("cost").number(kTime).value_or(end);
  for (const JsonReader item : json.find("visits").array().items()) {
    const core::Visit visit = parse_visit(item);
    if (json.fault_count() == before) plan.visits.push_back(visit);
  }
  return plan;
}

/// The robots by id, and which of them have a plan already.
class Roster {
 public:
  explicit Roster(const std::vector<ReadRobot>& robots) : names_(robots) {}

  /// The index of the robot that a plan is for, if there is one that has no plan yet.
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

std::vector<core::RobotPlan> parse_plans(const JsonReader& member, const std::vector<ReadRobot>& robots,
                                         const WorldFrame& frame) {
  std::vector<core::RobotPlan> plans;
  Roster roster(robots);
  for (const JsonReader item : member.array().items()) {
    const JsonReader json = item.object(kPlanMembers);
    core::RobotPlan plan = parse_plan(json, frame);
    if (const auto owner = roster.assign(json.require("robot"))) {
      plan.robot = *owner;
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

}  // namespace fleetplan::api
