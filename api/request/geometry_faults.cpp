#include "api/request/geometry_faults.h"

#include <array>
#include <charconv>

#include "api/json/faults.h"
#include "api/request/geometry_hints.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

/// With three significant digits: a gap may be as small as a nanometre.
std::string short_text(double number) {
  std::array<char, 32> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::general, 3);
  return {buffer.data(), result.ptr};
}

std::string metres(double length) { return short_text(length) + " m"; }

/// The robot's id, or its number when it has none.
std::string name_of(const std::vector<ReadRobot>& robots, std::size_t index) {
  const std::string& id = robots[index].robot.id;
  return id.empty() ? "number " + std::to_string(index) : in_quotes(id);
}

/// What the robot overlaps: the zone, if it is one.
std::string obstacle_name(const core::ProblemFault& found, const std::vector<core::Zone>& zones) {
  return found.zone ? "the blocked zone " + in_quotes(zones[*found.zone].id)
                    : "a blocked cell or the edge of the map";
}

/// `outside`: see outside_text.
std::string in_obstacle(const std::string& pose, const std::string& robot, double radius, double gap,
                        const std::string& obstacle, const std::string& outside) {
  if (!outside.empty()) return "The " + pose + " of robot " + robot + ' ' + outside;
  return "The " + pose + " of robot " + robot + " does not fit: its disk overlaps " + obstacle + " by " +
         metres(-gap) + " (radius " + number_text(radius) + " m). Move it or make the robot smaller.";
}

std::string overlap(const char* poses, const std::string& earlier, const std::string& later, double gap) {
  return "The " + std::string(poses) + " of robots " + earlier + " and " + later +
         " overlap: the gap between their disks is " + metres(gap) + "; move them apart.";
}

std::string goal_name(const ReadRobot& read, std::size_t goal) {
  return read.goals.size() < 2 ? "goal" : "goal " + std::to_string(goal) + " (from 0)";
}

/// The action that is executed at the time, or begins then, as it stands in the request; the start of a robot
/// without any.
JsonReader action_at(const ReadRobot& read, double t, bool begins = false) {
  JsonReader place = read.start;
  for (const JsonReader item : read.committed.items()) {
    place = item;
    const double t_end = item.find("t_end").number(kDuration).value_or(0.0);
    if (begins ? t_end > t : t_end >= t) break;
  }
  return place;
}

std::string collision(const core::ProblemFault& found, const std::string& robot, const std::string& other,
                      const std::string& obstacle) {
  const std::string at = " at t = " + number_text(found.t) + " s";
  if (found.other == found.robot) {
    return "The committed motion of robot " + robot + " overlaps " + obstacle + " by " + metres(-found.gap) +
           at + "; correct the actions or the " + (found.zone ? "zone." : "map.");
  }
  return "The committed motion of robot " + robot + " meets robot " + other + at +
         ": the gap between their disks is " + metres(found.gap) +
         "; commit fewer actions of one of them, or stop one of them earlier.";
}

}  // namespace

GeometryFault describe(const core::ProblemFault& found, const Fleet& fleet,
                       const std::vector<std::size_t>& indices, const core::OccupancyGrid& grid) {
  using Kind = core::ProblemFault::Kind;
  const std::vector<ReadRobot>& robots = fleet.robots;
  const std::string obstacle = obstacle_name(found, fleet.zones);
  const ReadRobot& read = robots[indices[found.robot]];
  const std::string name = name_of(robots, indices[found.robot]);
  const std::string other = name_of(robots, indices[found.other]);
  const auto outside = [&](const JsonReader& pose) { return outside_text(pose, grid, fleet.map->frame); };
  switch (found.kind) {
    case Kind::start_in_obstacle:
      return {read.start, fault::kStartInObstacle,
              in_obstacle("start", name, read.robot.radius, found.gap, obstacle, outside(read.start))};
    case Kind::goal_in_obstacle:
      return {read.goals[found.goal], fault::kGoalInObstacle,
              in_obstacle(goal_name(read, found.goal), name, found.radius, found.gap, obstacle,
                          outside(read.goals[found.goal]))};
    case Kind::starts_overlap:
      return {read.start, fault::kStartsOverlap, overlap("starts", other, name, found.gap)};
    case Kind::goals_overlap:
      return {read.goals.back(), fault::kGoalsOverlap, overlap("goals", other, name, found.gap)};
    case Kind::committed_in_zone:
      return {action_at(read, found.t, true), fault::kCommittedInZone,
              "This committed action of robot " + name + " breaks the rule of the zone " +
                  in_quotes(fleet.zones[*found.zone].id) +
                  ": it is faster than the zone allows, or against its direction. Correct the action or the "
                  "zone."};
    case Kind::committed_collision:
      break;
  }
  return {action_at(read, found.t), fault::kCommittedCollision, collision(found, name, other, obstacle)};
}

}  // namespace fleetplan::api
