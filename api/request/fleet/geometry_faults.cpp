#include "api/request/fleet/geometry_faults.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "api/json/errors.h"
#include "api/request/limits.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::api {

namespace {

using core::Position;
using FaultKind = core::ProblemFault::Kind;

/// If this share of the robots is at fault, with at least so many faults, they are rather described wrongly
/// than placed wrongly.
constexpr double kShareOfAll = 0.5;
constexpr std::size_t kFewestFaults = 2;
/// A disk that overlaps a wall by this share of its radius is in it, and not only too near.
constexpr double kDeep = 0.99;
/// Poses between two looks at the stop condition.
constexpr std::size_t kPosesBetweenPolls = 16;

/// Returns the position of a pose in the request, which may have faults, in the world.
std::optional<Position> position_of(const JsonReader& pose) {
  const JsonReader x = pose.find("x");
  const JsonReader y = pose.find("y");
  if (!x.is_number() || !y.is_number()) return std::nullopt;
  return Position(*x.value().number(), *y.value().number());
}

/// Whether a disk is on the map, or its centre for the radius 0.
bool is_on(const core::OccupancyGrid& grid, const Position& position, double radius) {
  return position.x() >= radius && position.x() <= grid.width() - radius && position.y() >= radius &&
         position.y() <= grid.height() - radius;
}

std::string interval(double low, double length) {
  return number_text(low) + " to " + number_text(low + length) + " m";
}

/// Returns the unit in which a disk would be on the map, for a sentence; empty if there is none.
std::string fitting_unit(const Position& world, double radius, const core::OccupancyGrid& grid,
                         const WorldFrame& frame) {
  // Pixels count from the corner of the map.
  const bool is_pixel = grid.resolution() < 1.0 && is_on(grid, world * grid.resolution(), radius);
  if (is_pixel) return "pixels of " + number_text(grid.resolution()) + " m";
  struct Unit {
    double metres;
    const char* name;
  };
  for (const Unit& unit : {Unit{0.01, "centimetres"}, Unit{0.001, "millimetres"}}) {
    if (is_on(grid, frame.to_map(world * unit.metres), radius)) return unit.name;
  }
  return "";
}

/// Returns the phrase of a fault about a pose whose centre is not on the map, and about its probable unit.
/// For example: "is at (52.5, 3), outside the map, which ...". Empty if the pose is on the map.
std::string outside_text(const JsonReader& pose, double radius, const core::OccupancyGrid& grid,
                         const WorldFrame& frame) {
  const auto world = position_of(pose);
  if (!world || is_on(grid, frame.to_map(*world), 0.0)) return "";
  const std::string unit = fitting_unit(*world, radius, grid, frame);
  return "is at (" + number_text(world->x()) + ", " + number_text(world->y()) +
         "), outside the map, which reaches from " + interval(frame.origin.x(), grid.width()) +
         " in x and from " + interval(frame.origin.y(), grid.height()) + " in y. " +
         (unit.empty() ? "Move it onto the map, or correct the origin and resolution of the map."
                       : "Give it in metres: in " + unit + " it would be on the map.");
}

/// Whether the disks of the starts and goals of all robots would fit with other positions or radii.
class Trial {
 public:
  Trial(const Fleet& fleet, const std::vector<std::size_t>& indices, const core::StaticMap& map,
        const core::StopCondition& stop)
      : fleet_(fleet), indices_(indices), map_(map), stop_(stop) {}

  bool all_fit(bool mirrored, double radius_factor) {
    core::StopStride stride(stop_, kPosesBetweenPolls);
    const auto fits = [&](const JsonReader& pose, double radius) {
      if (stride.met_at_step()) return false;
      const auto world = position_of(pose);
      if (!world) return true;  // has a fault of its own
      Position position = fleet_.map->frame.to_map(*world);
      if (mirrored) position.y() = map_.grid().height() - position.y();
      return map_.sight().disk_fits(position, radius_factor * radius - core::kContactTolerance);
    };
    for (const std::size_t index : indices_) {
      const ParsedRobot& read = fleet_.robots[index];
      double radius = read.robot.radius;
      if (!fits(read.start, radius)) return false;
      for (const JsonReader& goal : read.goals) {
        const JsonReader after = goal.find("radius_after");
        const double leaves = after.is_number() ? *after.value().number() : radius;
        if (!fits(goal, std::max(radius, leaves))) return false;
        radius = leaves;
      }
    }
    return true;
  }

 private:
  const Fleet& fleet_;
  const std::vector<std::size_t>& indices_;
  const core::StaticMap& map_;
  const core::StopCondition& stop_;
};

bool is_of_pair(FaultKind kind) {
  return kind == FaultKind::starts_overlap || kind == FaultKind::goals_overlap;
}

bool is_of_wall(const core::ProblemFault& found) {
  return (found.kind == FaultKind::start_in_obstacle || found.kind == FaultKind::goal_in_obstacle) &&
         !found.zone;
}

}  // namespace

std::string common_cause(const core::ProblemFaults& faults, const Fleet& fleet,
                         const std::vector<std::size_t>& indices, const core::StaticMap& map,
                         const core::StopCondition& stop) {
  std::set<std::size_t> at_fault;
  bool any_wall = false;
  bool any_deep = false;  // a centre is in a wall, or off the map
  bool all_of_walls = true;
  bool half_parts_pairs = true;  // with half the radii, the disks of the pairs would not overlap
  for (const core::ProblemFault& found : faults.listed) {
    if (!is_of_wall(found) && !is_of_pair(found.kind)) return "";
    at_fault.insert(found.robot);
    any_wall = any_wall || is_of_wall(found);
    any_deep = any_deep || (is_of_wall(found) && found.gap <= -kDeep * found.radius);
    if (!is_of_pair(found.kind)) continue;
    all_of_walls = false;
    at_fault.insert(found.other);
    const double sum =
        fleet.robots[indices[found.robot]].robot.radius + fleet.robots[indices[found.other]].robot.radius;
    half_parts_pairs = half_parts_pairs && found.gap + 0.5 * sum >= -core::kContactTolerance;
  }
  const bool is_whole = faults.total == faults.listed.size();
  const bool are_many =
      faults.total >= kFewestFaults &&
      static_cast<double>(at_fault.size()) >= kShareOfAll * static_cast<double>(indices.size());
  Trial trial(fleet, indices, map, stop);
  if (are_many && half_parts_pairs && (is_whole || all_of_walls) && trial.all_fit(false, 0.5)) {
    return " With half the radii, all starts and goals would fit: is radius given as the diameter?";
  }
  if (any_wall && all_of_walls && (any_deep || are_many) && trial.all_fit(true, 1.0)) {
    return " With y mirrored, all starts and goals would fit: y points up, and the first of rows is the top "
           "one.";
  }
  return "";
}

namespace {

/// Returns a number with three significant digits: a gap may be as small as a nanometre.
std::string short_text(double number) {
  std::array<char, 32> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::general, 3);
  return {buffer.data(), result.ptr};
}

std::string metres(double length) { return short_text(length) + " m"; }

/// Returns the robot's id, or its number when it has none.
std::string name_of(const std::vector<ParsedRobot>& robots, std::size_t index) {
  const std::string& id = robots[index].robot.id;
  return id.empty() ? "number " + std::to_string(index) : in_quotes(id);
}

/// Returns what the robot overlaps: the name of the zone, if it is one.
std::string obstacle_name(const core::ProblemFault& found, const std::vector<core::Zone>& zones) {
  return found.zone ? "the blocked zone " + in_quotes(zones[*found.zone].id)
                    : "a blocked cell or the edge of the map";
}

/// Returns the detail of a disk in an obstacle. `outside`: see outside_text; `remedy` begins with a space.
std::string in_obstacle(const std::string& pose, double radius, double gap, const std::string& obstacle,
                        const std::string& outside, const std::string& remedy) {
  if (!outside.empty()) return "The " + pose + ' ' + outside;
  return "The " + pose + " does not fit: its disk overlaps " + obstacle + " by " + metres(-gap) +
         " (radius " + number_text(radius) + " m)." + remedy;
}

/// Returns a length for a remedy, rounded up to millimetres.
std::string rounded_up(double length) {
  constexpr double kPerMetre = 1e3;
  constexpr double kRounding = 1e-4;  // millimetres, less than a contact
  return number_text(std::ceil(length * kPerMetre - kRounding) / kPerMetre);
}

/// Returns a coordinate in the world of NearestGoals, which has six decimals at most.
std::string coordinate_text(double world) {
  constexpr double kDecimals = 1e6;
  return number_text(std::round(world * kDecimals) / kDecimals);
}

/// Whether a disk that overlaps an obstacle has its centre outside of it: an option allows for that.
bool may_overlap(const core::ProblemFault& found) {
  return -found.gap < (1.0 - 2.0 * core::kSmallestDisk) * found.radius;
}

/// Returns the option that allows for the overlap, such as "options.start_overlap of at least 0.05 m".
std::string overlap_text(const char* option, const core::ProblemFault& found, double inflation) {
  return std::string("options.") + option + " of at least " + rounded_up(inflation - found.gap) + " m";
}

/// Returns the remedy for a goal at this place of the request that does not fit. `stays`: the robot may stay
/// there, because it is its last goal.
std::string goal_remedy(const core::ProblemFault& found, const JsonReader& goal, bool stays, double inflation,
                        const WorldFrame& frame, NearestGoals& nearest) {
  const std::string in_dock = stays && may_overlap(found)
                                  ? ". If the robot is to stay there, as in a dock, give " +
                                        overlap_text("goal_overlap", found, inflation) + '.'
                                  : ".";
  const auto position = position_of(goal);
  const auto place = position ? nearest.of(found, frame.to_map(*position)) : std::nullopt;
  if (!place) return " Move it, or make the robot smaller" + in_dock;
  const Position world = frame.to_world(*place);
  return " The nearest place that fits is (" + coordinate_text(world.x()) + ", " +
         coordinate_text(world.y()) + "), " + metres((world - *position).norm()) +
         " away. Move the goal there, or make the robot smaller" + in_dock;
}

/// Returns what helps a start that does not fit. A robot that was measured there stands there. `option`: what
/// allows for it.
std::string start_remedy(const core::ProblemFault& found, const char* option, double inflation) {
  std::string text = " If the robot stands there, as in a dock or beside a wall,";
  const bool is_outside = may_overlap(found);
  if (is_outside) text += " give " + overlap_text(option, found, inflation);
  if (found.zone) text += std::string(is_outside ? ", or" : " give") + " the zone \"enter\": false";
  if (!is_outside && !found.zone) return " Move it, or correct the map or the radius.";
  return text + ". Otherwise move it, or make the robot smaller.";
}

std::string overlap(const char* poses, const std::string& earlier, const std::string& later, double gap,
                    const std::string& remedy) {
  return "The " + std::string(poses) + " of robots " + earlier + " and " + later +
         " overlap: the gap between their disks is " + metres(gap) + "; move them apart" + remedy;
}

/// Returns what helps starts that overlap: measured positions are never exact. Of disks that overlap by half,
/// one is not where it should be.
std::string starts_remedy(double gap, double sum, double inflation) {
  if (-gap > 0.5 * sum) return ".";
  return ", or if they were measured there, give options.start_overlap of at least " +
         rounded_up(2.0 * inflation - gap) + " m.";
}

constexpr const char* kGoalsRemedy =
    ", let one of the robots go on after its goal with \"idle\": \"yield\", or give them a choice of poses "
    "with any_of.";

std::string goal_name(const ParsedRobot& read, std::size_t goal) {
  return read.goals.size() < 2 ? "goal" : "goal " + std::to_string(goal) + " (from 0)";
}

/// Returns the action that is executed at the time, or begins then, as it stands in the request. For a robot
/// without actions, returns its start.
JsonReader action_at(const ParsedRobot& read, double t, bool begins = false) {
  JsonReader place = read.start;
  for (const JsonReader item : read.committed.items()) {
    place = item;
    const double t_end = item.find("t_end").number(kDuration).value_or(0.0);
    if (begins ? t_end > t : t_end >= t) break;
  }
  return place;
}

/// `rests`: the other robot has no motion, and no goal.
std::string collision(const core::ProblemFault& found, const std::string& robot, const std::string& other,
                      const std::string& obstacle, const std::string& rests) {
  const std::string at = " at t = " + number_text(found.t) + " s";
  if (found.other == found.robot) {
    return "The committed motion of robot " + robot + " overlaps " + obstacle + " by " + metres(-found.gap) +
           at + "; correct the actions or the " + (found.zone ? "zone." : "map.");
  }
  if (!rests.empty()) {
    return "The committed motion of robot " + robot + " meets robot " + other + at +
           ": the gap between their disks is " + metres(found.gap) + ". Robot " + rests +
           " has no goal and stays; let it make way with \"idle\": \"yield\", or commit fewer actions.";
  }
  return "The committed motion of robot " + robot + " meets robot " + other + at +
         ": the gap between their disks is " + metres(found.gap) +
         "; commit fewer actions of one of them, or stop one of them earlier.";
}

}  // namespace

std::optional<Position> NearestGoals::of(const core::ProblemFault& found, const Position& goal) {
  if (!maps_.finished()) return std::nullopt;
  const double radius = found.radius + inflation_ - core::kContactTolerance + core::kSearchSlack;
  const double overlap = std::max(-found.gap - core::kContactTolerance, 0.0) + inflation_;
  return places_.of(maps_.while_leaving(found.robot)->sight(), goal, radius, overlap);
}

std::string describe_pose(const core::ProblemFault& found, const JsonReader& pose, const core::Robot& robot,
                          double inflation, const std::vector<core::Zone>& zones,
                          const core::OccupancyGrid& grid, const WorldFrame& frame, NearestGoals& nearest) {
  const std::string remedy = found.kind == core::ProblemFault::Kind::start_in_obstacle
                                 ? start_remedy(found, "start_overlap", inflation)
                                 : goal_remedy(found, pose, true, inflation, frame, nearest);
  return in_obstacle("pose", robot.radius, found.gap, obstacle_name(found, zones),
                     outside_text(pose, robot.radius, grid, frame), remedy);
}

namespace {

/// Whether a robot of the fleet stays where it is: it has neither a goal nor motion.
bool rests(const ParsedRobot& read) {
  return read.goals.empty() && read.committed.size() == 0 && read.idle.value_or(Idle::stay) == Idle::stay;
}

/// Whether a robot of the fleet stays at this goal.
bool stays_at(const ParsedRobot& read, std::size_t goal) {
  return goal + 1 == read.goals.size() && read.idle.value_or(Idle::stay) != Idle::yield;
}

}  // namespace

GeometryFault describe(const core::ProblemFault& found, const Fleet& fleet,
                       const std::vector<std::size_t>& indices, const core::OccupancyGrid& grid,
                       NearestGoals& nearest) {
  using Kind = core::ProblemFault::Kind;
  const std::vector<ParsedRobot>& robots = fleet.robots;
  const std::string obstacle = obstacle_name(found, fleet.zones);
  const ParsedRobot& read = robots[indices[found.robot]];
  const ParsedRobot& read_other = robots[indices[found.other]];
  const std::string name = name_of(robots, indices[found.robot]);
  const std::string other = name_of(robots, indices[found.other]);
  const double inflation = fleet.options.plan.inflation;
  const WorldFrame& frame = fleet.map->frame;
  switch (found.kind) {
    case Kind::start_in_obstacle:
      return {read.start, fault::kStartInObstacle,
              in_obstacle(
                  "start of robot " + name, read.robot.radius, found.gap, obstacle,
                  outside_text(read.start, read.robot.radius, grid, frame),
                  start_remedy(found, read.returns_to_start ? "goal_overlap" : "start_overlap", inflation))};
    case Kind::goal_in_obstacle:
      return {read.goals[found.goal], fault::kGoalInObstacle,
              in_obstacle(goal_name(read, found.goal) + " of robot " + name, found.radius, found.gap,
                          obstacle, outside_text(read.goals[found.goal], found.radius, grid, frame),
                          goal_remedy(found, read.goals[found.goal], stays_at(read, found.goal), inflation,
                                      frame, nearest))};
    case Kind::starts_overlap:
      return {read.start, fault::kStartsOverlap,
              overlap("starts", other, name, found.gap,
                      starts_remedy(found.gap, read.robot.radius + read_other.robot.radius, inflation))};
    case Kind::goals_overlap:
      return {read.goals.back(), fault::kGoalsOverlap,
              overlap("goals", other, name, found.gap, kGoalsRemedy)};
    case Kind::committed_in_zone:
      return {action_at(read, found.t, true), fault::kCommittedInZone,
              "This committed action of robot " + name + " breaks the rule of the zone " +
                  in_quotes(fleet.zones[*found.zone].id) +
                  ": it is faster than the zone allows, or against its direction. Correct the action or the "
                  "zone."};
    case Kind::committed_collision:
      break;
  }
  const std::string resting = rests(read) ? name : rests(read_other) ? other : "";
  return {action_at(read, found.t), fault::kCommittedCollision,
          collision(found, name, other, obstacle, resting)};
}

}  // namespace fleetplan::api
