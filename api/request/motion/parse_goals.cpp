#include "api/request/motion/parse_goals.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "api/request/parse_metadata.h"
#include "api/request/ranges.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 7> kGoalMembers{
    "x", "y", "theta", "service", "not_before", "radius_after", "metadata"};

/// Adds the goal if it is valid.
void add_goal(const JsonReader& member, const WorldFrame& frame, ReadGoals& read) {
  const std::size_t before = member.fault_count();
  const JsonReader json = member.object(kGoalMembers);
  auto goal = parse_pose(json, frame);
  const auto service = json.find("service").number(kDuration);
  const auto not_before = json.find("not_before").number(kDuration);
  const auto radius_after = json.find("radius_after").number(kLength);
  std::string metadata = parse_metadata(json);
  if (!goal || member.fault_count() != before) return;
  goal->service = service.value_or(0.0);
  goal->not_before = not_before.value_or(0.0);
  goal->radius_after = radius_after;
  if (service || not_before || radius_after || !metadata.empty()) read.lists_visits = true;
  if (!metadata.empty()) {
    read.metadata.resize(read.goals.size());
    read.metadata.push_back(std::move(metadata));
  }
  read.goals.push_back(*goal);
  read.places.push_back(member);
}

}  // namespace

std::optional<core::Goal> parse_pose(const JsonReader& pose, const WorldFrame& frame) {
  const std::size_t before = pose.fault_count();
  const auto x = pose.require("x").number(kCoordinate);
  const auto y = pose.require("y").number(kCoordinate);
  const auto theta = pose.find("theta").number(kAnyAngle);
  if (!x || !y || pose.fault_count() != before) return std::nullopt;
  core::Goal read;
  read.position = frame.to_map({*x, *y});
  if (theta) read.theta = core::normalize_angle(*theta);
  return read;
}

ReadGoals parse_goals(const JsonReader& robot, const WorldFrame& frame, Quota& quota) {
  ReadGoals read;
  const JsonReader single = robot.find("goal");
  const JsonReader several = robot.find("goals");
  if (single && several) {
    several.fault(fault::kDuplicate,
                  "The robot has both goal and goals; give one of them: goal is short for a list of one.");
  }
  if (single) add_goal(single, frame, read);
  const JsonReader list = several.array();
  if (single || !list || !quota.take(list)) return read;
  read.lists_visits = true;
  for (const JsonReader item : list.items()) add_goal(item, frame, read);
  return read;
}

}  // namespace fleetplan::api
