#include "api/execution/parse_retime_request.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "api/json/faults.h"
#include "api/request/motion/parse_dependencies.h"
#include "api/request/parse_options.h"
#include "api/request/parse_plans.h"
#include "api/request/parse_robots.h"
#include "api/request/ranges.h"
#include "api/request/robot_names.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 5> kStateMembers{"robot", "action", "progress", "speed_factor",
                                                        "held_s"};
constexpr Range kSpeedFactor{1e-3, 1e3, ""};
/// Seconds: what times that went through decimal text may be off.
constexpr double kContiguous = 1e-6;

/// Reports actions that are not contiguous in time. `plans`: in the order of the items of the list.
void check_times(const JsonReader& list, const std::vector<core::RobotPlan>& plans) {
  std::size_t plan = 0;
  // Bounded: items are read until the Work ends.
  for (const JsonReader item : list.items()) {
    double now = 0.0;
    std::size_t index = 0;
    for (const JsonReader action : item.find("actions").items()) {
      const core::Action& timed = plans[plan].actions[index++];
      if (std::abs(timed.t_start - now) > kContiguous) {
        action.find("t_start").fault(fault::kDiscontinuity, [&] {
          return "The action starts at " + number_text(timed.t_start) + " s, but it must start at " +
                 number_text(now) + " s, where the one before ends, or at 0 s.";
        });
      } else if (timed.t_end < timed.t_start) {
        action.find("t_end").fault(fault::kDiscontinuity, [&] {
          return "The action ends at " + number_text(timed.t_end) +
                 " s, before it starts; t_end must be at least t_start.";
        });
      }
      now = timed.t_end;
    }
    ++plan;
  }
}

class StateReader {
 public:
  StateReader(const std::vector<core::Robot>& robots, const std::vector<core::RobotPlan>& plans)
      : actions_(core::executed_actions(robots, plans)), names_(robots) {}

  std::optional<core::ObservedState> read(const JsonReader& item) {
    const JsonReader json = item.object(kStateMembers);
    const JsonReader action_member = json.require("action");
    core::ObservedState state;
    const auto robot = read_robot(json.require("robot"));
    const auto action = action_member.natural(kGreatestIndex);
    const auto fraction = json.require("progress").number(kFraction);
    state.speed_factor = json.find("speed_factor").number(kSpeedFactor).value_or(1.0);
    state.held = json.find("held_s").number(kDuration).value_or(0.0);
    if (!robot || !action || !fraction) return std::nullopt;
    const std::size_t count = actions_[*robot].size();
    if (*action >= count) {
      action_member.fault(fault::kOutOfRange, [&] {
        return "The robot has " + std::to_string(count) +
               " actions, numbered from 0; one that has arrived is at progress 1 of the last, and one "
               "without "
               "actions needs no state.";
      });
      return std::nullopt;
    }
    state.robot = *robot;
    state.action = *action;
    state.fraction = *fraction;
    return state;
  }

 private:
  std::optional<std::size_t> read_robot(const JsonReader& member) {
    const auto robot = names_.find(member);
    if (robot && !seen_.insert(*robot).second) {
      member.fault(fault::kDuplicate, "This robot already has a state; give only one.");
    }
    return robot;
  }

  std::vector<core::Actions> actions_;
  RobotNames names_;
  std::unordered_set<std::size_t> seen_;
};

}  // namespace

std::optional<RetimeRequest> parse_retime_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& stop) {
  RetimeRequest request;
  request.rules.wait_before_move = parse_options(root.find("options")).plan.wait_before_move;
  UniqueIds ids;
  // Without the map's frame, so that no number changes.
  std::vector<ReadRobot> robots =
      parse_robots(root.require("robots"), root.find("robot_defaults"), WorldFrame{}, limits, ids);
  const JsonReader plans = root.require("plans");
  request.plans = parse_plans(plans, robots, WorldFrame{});
  request.rules.now = root.require("at").number(kDuration).value_or(0.0);
  if (root.fault_count() > 0 || stop.met()) return std::nullopt;
  check_times(plans, request.plans);
  for (ReadRobot& robot : robots) request.robots.push_back(std::move(robot.robot));
  request.dependencies = parse_dependencies(root.require("dependencies"), request.robots, request.plans);
  StateReader reader(request.robots, request.plans);
  for (const JsonReader item : root.require("states").array().items()) {
    if (const auto state = reader.read(item)) request.states.push_back(*state);
  }
  if (root.fault_count() > 0 || stop.met()) return std::nullopt;
  return request;
}

}  // namespace fleetplan::api
