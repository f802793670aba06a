#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "api/execution/execution_requests.h"
#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/request/fleet/parse_plans.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/options.h"
#include "core/execution/executed_actions.h"
#include "core/model/itinerary.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 5> kStateMembers{"robot", "action", "progress", "speed_factor",
                                                        "held_s"};
constexpr Range kSpeedFactor{1e-3, 1e3, ""};
/// Seconds by which times that went through decimal text may be off.
constexpr double kContiguous = 1e-6;

/// Reports actions that are not contiguous in time. `plans` are in the order of the items of the list.
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
                                                  core::Work& work) {
  RetimeRequest request;
  request.rules.wait_before_move = parse_options(root.find("options")).plan.wait_before_move;
  UniqueIds ids;
  // The map's frame is not applied, so that no number changes.
  std::vector<ParsedRobot> robots =
      parse_robots(root.require("robots"), root.find("robot_defaults"), WorldFrame{}, limits, ids);
  const JsonReader plans = root.require("plans");
  request.plans = parse_plans(plans, robots, WorldFrame{});
  check_profiles(plans, request.plans);
  request.rules.now = root.require("at").number(kDuration).value_or(0.0);
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  check_times(plans, request.plans);
  for (ParsedRobot& robot : robots) request.robots.push_back(std::move(robot.robot));
  request.dependencies = parse_dependencies(root.require("dependencies"), request.robots, request.plans);
  StateReader reader(request.robots, request.plans);
  for (const JsonReader item : root.require("states").array().items()) {
    if (const auto state = reader.read(item)) request.states.push_back(*state);
  }
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  return request;
}

namespace {

/// Returns the new time of a planned time; none if the planned time is past.
std::optional<double> new_time(const core::Pace& pace, const core::RetimedRobot& retimed, double planned) {
  const double progress = pace.progress_at(planned);
  const auto action = static_cast<std::size_t>(progress);
  const double fraction = progress - std::floor(progress);
  if (fraction == 0.0) {
    if (action <= retimed.first) return std::nullopt;
    return retimed.ends[action - 1 - retimed.first];
  }
  if (action < retimed.first) return std::nullopt;
  const std::size_t index = action - retimed.first;
  const double begin = index == 0 ? retimed.begin : retimed.ends[index - 1];
  return begin + fraction * (retimed.ends[index] - begin);
}

void write_actions_left(JsonWriter& json, const core::RetimedRobot& retimed) {
  json.key("actions").begin_array();
  double begin = retimed.begin;
  for (std::size_t k = 0; k < retimed.ends.size(); ++k) {
    json.begin_object().member("action", retimed.first + k).member("t_start", begin);
    json.member("t_end", retimed.ends[k]).end_object();
    begin = retimed.ends[k];
  }
  json.end_array();
}

void write_visits_left(JsonWriter& json, const core::Robot& robot, core::Actions actions,
                       const core::RetimedRobot& retimed) {
  const core::Pace pace(actions);
  json.key("visits").begin_array();
  for (const core::Visit& visit : core::visits_of(robot, actions)) {
    if (robot.goal_at(visit.goal).anywhere) continue;
    const auto arrives = new_time(pace, retimed, visit.t_arrive);
    const bool stays = visit.t_leave == core::kForever;
    const auto leaves = stays ? std::nullopt : new_time(pace, retimed, visit.t_leave);
    if (!arrives && !leaves) continue;
    json.begin_object().member("goal", visit.goal).member("t_arrive", arrives);
    json.member("t_leave", leaves).end_object();
  }
  json.end_array();
}

}  // namespace

std::optional<std::string> write_retimed(const RetimeRequest& request,
                                         const std::vector<core::RetimedRobot>& retimed, core::Work& work) {
  // An action is as much work as reading so many bytes.
  constexpr std::size_t kWorkOfAnAction = 256;
  const auto actions = core::executed_actions(request.robots, request.plans);
  const auto id = [&](const std::optional<std::size_t>& robot) { return request.robots[*robot].id; };
  JsonWriter json;
  json.begin_object().key("robots").begin_array();
  for (std::size_t k = 0; k < retimed.size(); ++k) {
    if (work.met_after(kWorkOfAnAction * (1 + actions[k].size()))) return std::nullopt;
    json.begin_object().member("robot", request.robots[k].id);
    json.member("t_end", retimed[k].ends.empty() ? retimed[k].begin : retimed[k].ends.back());
    json.member("delay", retimed[k].delay);
    write_actions_left(json, retimed[k]);
    write_visits_left(json, request.robots[k], actions[k], retimed[k]);
    json.end_object();
  }
  json.end_array().key("late").begin_array();
  for (std::size_t k = 0; k < retimed.size(); ++k) {
    if (!retimed[k].because_of) continue;
    json.begin_object().member("robot", request.robots[k].id).member("delay", retimed[k].delay);
    json.key("waits_for");
    if (retimed[k].waits_for) {
      json.value(id(retimed[k].waits_for));
    } else {
      json.json("null");
    }
    json.member("because_of", id(retimed[k].because_of)).end_object();
  }
  json.end_array().end_object();
  return json.take();
}

}  // namespace fleetplan::api
