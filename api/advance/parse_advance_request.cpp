#include "api/advance/parse_advance_request.h"

#include <array>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "api/request/motion/parse_goals.h"
#include "api/request/motion/parse_obstacles.h"
#include "api/request/parse_body.h"
#include "api/request/parse_plans.h"
#include "api/request/ranges.h"
#include "api/request/robot_names.h"
#include "core/geometry/angle.h"
#include "core/model/drive_zones.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 7> kRequestMembers{"map",   "robot_defaults", "robots",  "obstacles",
                                                          "zones", "options",        "metadata"};
constexpr std::array<std::string_view, 4> kPoseMembers{"robot", "x", "y", "theta"};
constexpr std::array<std::string_view, 2> kHoldMembers{"robot", "until"};
constexpr std::array<std::string_view, 2> kGoalsMembers{"robot", "goals"};

/// Reads a list of entries of robots, at most one for each. `read` gets an entry and its robot's index.
template <typename Read>
void read_entries(const JsonReader& list, std::span<const std::string_view> members, const RobotNames& names,
                  const Read& read) {
  std::unordered_set<std::size_t> seen;
  for (const JsonReader item : list.array().items()) {
    const JsonReader entry = item.object(members);
    const JsonReader robot = entry.require("robot");
    const auto index = names.find(robot);
    if (index && !seen.insert(*index).second) {
      robot.fault(fault::kDuplicate, "This robot already has an entry in this list; give only one.");
    }
    read(entry, index);
  }
}

std::optional<core::Pose> parse_measured(const JsonReader& entry) {
  const auto x = entry.require("x").number(kCoordinate);
  const auto y = entry.require("y").number(kCoordinate);
  const auto theta = entry.require("theta").number(kAnyAngle);
  if (!x || !y || !theta) return std::nullopt;
  return core::Pose{{*x, *y}, core::normalize_angle(*theta)};
}

void parse_events(const JsonReader& root, const RobotNames& names, const Limits& limits,
                  AdvanceRequest& request) {
  std::vector<Execution>& executions = request.executions;
  Quota quota(limits.max_goals, "goals");
  read_entries(root.find("poses"), kPoseMembers, names, [&](const JsonReader& entry, auto robot) {
    const auto pose = parse_measured(entry);
    if (robot) executions[*robot].measured = pose;
  });
  read_entries(root.find("holds"), kHoldMembers, names, [&](const JsonReader& entry, auto robot) {
    const auto until = entry.require("until").number(kDuration);
    if (robot) executions[*robot].hold = until;
  });
  read_entries(root.find("goals"), kGoalsMembers, names, [&](const JsonReader& entry, auto robot) {
    entry.require("goals");
    ReadGoals goals = parse_goals(entry, WorldFrame{}, quota);
    if (!robot) return;
    executions[*robot].goals = std::move(goals.goals);
    request.goal_metadata[*robot] = std::move(goals.metadata);
  });
}

std::vector<core::Zone> in_world(std::vector<core::Zone> zones, const WorldFrame& frame) {
  // Bounded: each corner once.
  for (core::Zone& zone : zones) {
    for (core::Position& corner : zone.polygon) corner = frame.to_world(corner);
  }
  return zones;
}

}  // namespace

std::optional<AdvanceRequest> parse_advance_request(const JsonReader& root, const Limits& limits,
                                                    core::Work& stop) {
  AdvanceRequest read;
  read.request = root.require("request").object(kRequestMembers);
  const Fleet fleet = parse_fleet(read.request, limits, [&](const ReadOptions& options) {
    stop.set_budget(effective_budget(options, limits));
  });
  read.moment.at = root.require("at").number(kDuration).value_or(0.0);
  read.moment.commit = root.find("commit").number(kDuration);
  if (const auto tolerance = root.find("pose_tolerance").number(kLengthOrZero)) {
    read.moment.pose_tolerance = *tolerance;
  }
  read.moment.wait_before_move = fleet.options.plan.wait_before_move;
  read.moment.inflation = fleet.options.plan.inflation;
  read.executions.resize(fleet.robots.size());
  read.goal_metadata.resize(fleet.robots.size());
  parse_events(root, RobotNames(fleet.robots, "robots of the request"), limits, read);
  // Without the map's frame, so that no number changes.
  for (core::RobotPlan& plan : parse_plans(root.require("plans"), fleet.robots, WorldFrame{})) {
    read.executions[plan.robot].actions = std::move(plan.actions);
    read.executions[plan.robot].planned = true;
  }
  if (!read.request || root.fault_count() > 0 || stop.met()) return std::nullopt;
  if (fleet.map) read.moment.zones = in_world(fleet.zones, fleet.map->frame);
  std::size_t corners = fleet.zones.size();
  for (const core::Zone& zone : fleet.zones) corners += zone.polygon.size();
  UniqueIds unique_ids;
  auto robots = parse_robots(read.request.find("robots"), read.request.find("robot_defaults"), WorldFrame{},
                             limits, unique_ids);
  for (ReadRobot& robot : robots) {
    const std::size_t index = read.robots.size();
    if (stop.met_after(corners)) return std::nullopt;
    if (!read.executions[index].goals) read.goal_metadata[index] = std::move(robot.goal_metadata);
    // A robot that is off its path turns back as slowly as it has to anywhere.
    const core::DriveZones zones(fleet.zones, index, robot.robot);
    robot.robot.angular_speed = zones.least_angular_speed();
    read.robots.push_back(std::move(robot.robot));
  }
  read.obstacles = parse_obstacles(read.request.find("obstacles"), WorldFrame{}, limits, unique_ids);
  for (std::size_t k = 0; k < read.robots.size(); ++k) {
    if (!read.executions[k].planned) read.executions[k].actions = read.robots[k].committed;
  }
  return stop.met() ? std::nullopt : std::optional(std::move(read));
}

}  // namespace fleetplan::api
