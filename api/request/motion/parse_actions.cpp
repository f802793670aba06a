#include "api/request/motion/parse_actions.h"

#include <array>
#include <string_view>
#include <utility>

#include "api/request/motion/action_chain.h"
#include "api/request/ranges.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 7> kActionMembers{"type", "t_start", "t_end",  "from",
                                                         "to",   "goal",    "reverse"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};
constexpr std::array<std::string_view, 3> kTypes{"rotate", "translate", "wait"};  // as in core::Action::Type

core::Pose parse_pose(const JsonReader& member) {
  const JsonReader pose = member.object(kPoseMembers);
  const double x = pose.require("x").number(kCoordinate).value_or(0.0);
  const double y = pose.require("y").number(kCoordinate).value_or(0.0);
  return {{x, y}, pose.require("theta").number(kAnyAngle).value_or(0.0)};
}

bool gives_back(const core::Pose& map, const core::Pose& world, const WorldFrame& frame) {
  return frame.to_world(map.position) == world.position && map.theta == world.theta;
}

/// Whether the answer would contain the action as received.
bool gives_back(const core::Action& map, const core::Action& world, const WorldFrame& frame) {
  return map.t_start == world.t_start && map.t_end == world.t_end &&
         gives_back(map.from, world.from, frame) && gives_back(map.to, world.to, frame);
}

}  // namespace

core::Action parse_action(const JsonReader& item, const Range& times) {
  const JsonReader json = item.object(kActionMembers);
  core::Action action;
  const auto type = json.require("type").word(kTypes);
  if (type) action.type = static_cast<core::Action::Type>(*type);
  action.t_start = json.require("t_start").number(times).value_or(0.0);
  action.t_end = json.require("t_end").number(times).value_or(0.0);
  action.from = parse_pose(json.require("from"));
  action.to = parse_pose(json.require("to"));
  const JsonReader goal = json.find("goal");
  if (goal && type && action.type != core::Action::Type::wait) {
    goal.fault(fault::kUnknownKey, [] { return "goal is a member of wait actions only; remove it."; });
  } else if (const auto number = goal.natural(kGreatestIndex)) {
    action.goal = *number;
  }
  const JsonReader reverse = json.find("reverse");
  action.reverse = reverse.boolean().value_or(false);
  if (action.reverse && type && action.type != core::Action::Type::translate) {
    reverse.fault(fault::kUnknownKey, [] { return "reverse is for translate actions only; remove it."; });
  }
  return action;
}

core::Action to_map(const core::Action& world, const WorldFrame& frame) {
  core::Action action = world;
  for (core::Pose* pose : {&action.from, &action.to}) {
    *pose = {frame.to_map(pose->position), core::normalize_angle(pose->theta)};
  }
  return action;
}

std::optional<ReadActions> parse_actions(const JsonReader& list, const ActionsOwner& owner,
                                         const WorldFrame& frame) {
  const JsonReader items = list.array();
  if (!items) return std::nullopt;
  const std::size_t before = items.fault_count();
  ReadActions read;
  ActionChain chain(owner);
  for (const JsonReader item : items.items()) {
    const std::size_t faults = items.fault_count();
    const core::Action world = parse_action(item, kDuration);
    if (items.fault_count() != faults) {
      chain.skip();
      continue;
    }
    const core::Action action = chain.append(to_map(world, frame), item);
    // After the first fault only faults matter: items may be many more than actions of that size.
    if (items.fault_count() != before) continue;
    if (!gives_back(action, world, frame)) read.received.keep(read.actions.size(), world);
    read.actions.push_back(action);
  }
  if (items.fault_count() != before) return std::nullopt;
  return read;
}

}  // namespace fleetplan::api
