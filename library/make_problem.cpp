#include "library/make_problem.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include "core/map/lattice.h"
#include "core/map/static_map.h"
#include "core/runtime/stop_condition.h"
#include "library/convert.h"
#include "library/ranges.h"
#include "library/read_actions.h"

namespace fleetplan::library {

namespace {

constexpr Range kHalfAngle{kLeastHalfAngle, std::numbers::pi, " rad"};
constexpr Range kDue{-kLongestTime, kLongestTime, " s"};
constexpr Range kWeight{kLeastWeight, kMostWeight, ""};
constexpr Range kHorizon{kShortestHorizon, kLongestTime, " s"};

void check_position(double x, double y, const std::string& place, FaultList& faults) {
  faults.check(x, kCoordinate, place + ".x");
  faults.check(y, kCoordinate, place + ".y");
}

void check_goal(const Goal& goal, const std::string& place, FaultList& faults) {
  check_position(goal.x, goal.y, place, faults);
  if (goal.theta) faults.check(*goal.theta, kAngle, place + ".theta");
  faults.check(goal.service, kDuration, place + ".service");
  faults.check(goal.not_before, kDuration, place + ".not_before");
  const auto check = [&](const std::optional<double>& number, const Range& range, const char* name) {
    if (number) faults.check(*number, range, place + name);
  };
  check(goal.radius_after, kLength, ".radius_after");
  check(goal.linear_speed_after, kLinearSpeed, ".linear_speed_after");
  check(goal.linear_acceleration_after, kAcceleration, ".linear_acceleration_after");
  check(goal.linear_deceleration_after, kAcceleration, ".linear_deceleration_after");
  if (!goal.due) return;
  faults.check(*goal.due, kDue, place + ".due");
  if (goal.not_before > 0.0 && *goal.due < goal.not_before) {
    faults.add(place + ".due", "The goal is due before its not_before.");
  }
}

void check_robot(const Robot& robot, const std::string& place, FaultList& faults) {
  faults.check(robot.radius, kLength, place + ".radius");
  faults.check(robot.linear_speed, kLinearSpeed, place + ".linear_speed");
  faults.check(robot.angular_speed, kAngularSpeed, place + ".angular_speed");
  faults.check(robot.vicinity, kLengthOrZero, place + ".vicinity");
  faults.check(robot.weight, kWeight, place + ".weight");
  const auto check_limit = [&](const std::optional<double>& limit, const char* name) {
    if (limit) faults.check(*limit, kAcceleration, place + name);
  };
  check_limit(robot.linear_acceleration, ".linear_acceleration");
  check_limit(robot.linear_deceleration, ".linear_deceleration");
  check_limit(robot.angular_acceleration, ".angular_acceleration");
  check_position(robot.start.x, robot.start.y, place + ".start", faults);
  faults.check(robot.start.theta, kAngle, place + ".start.theta");
  const bool is_limited = robot.linear_acceleration || robot.linear_deceleration;
  for (std::size_t k = 0; k < robot.goals.size(); ++k) {
    const std::string here = item(place + ".goals", k);
    check_goal(robot.goals[k], here, faults);
    if (is_limited || !(robot.goals[k].linear_acceleration_after || robot.goals[k].linear_deceleration_after))
      continue;
    faults.add(here, "A load changes the acceleration of a robot that has no linear_acceleration.");
  }
}

void check_obstacle(const MovingObstacle& obstacle, const std::string& place, FaultList& faults) {
  faults.check(obstacle.radius, kLength, place + ".radius");
  if (obstacle.motion.empty())
    faults.add(place + ".motion", "The motion has no entry; it needs one at least.");
  for (std::size_t k = 0; k < obstacle.motion.size(); ++k) {
    const MovingObstacle::Entry& entry = obstacle.motion[k];
    const std::string here = item(place + ".motion", k);
    faults.check(entry.t, kDuration, here + ".t");
    check_position(entry.position.x, entry.position.y, here + ".position", faults);
    if (k == 0) continue;
    const MovingObstacle::Entry& before = obstacle.motion[k - 1];
    const double duration = entry.t - before.t;
    const double distance =
        std::hypot(entry.position.x - before.position.x, entry.position.y - before.position.y);
    if (duration <= 0.0) faults.add(here + ".t", "The entry is not later than the one before.");
    if (duration > 0.0 && distance > kMostLinearSpeed * duration) {
      faults.add(here, "The obstacle moves faster than " + number_text(kMostLinearSpeed) + " m/s.");
    }
  }
}

void check_zone(const Zone& zone, std::size_t robots, const std::string& place, FaultList& faults) {
  constexpr std::size_t kFewestCorners = 3;
  if (zone.polygon.size() < kFewestCorners)
    faults.add(place + ".polygon", "A polygon has at least 3 corners.");
  for (std::size_t k = 0; k < zone.polygon.size(); ++k) {
    const std::string here = item(place + ".polygon", k);
    check_position(zone.polygon[k].x, zone.polygon[k].y, here, faults);
    if (zone.polygon[k] == zone.polygon[k == 0 ? zone.polygon.size() - 1 : k - 1]) {
      faults.add(here, "The corner equals the one before; the first one follows the last one.");
    }
  }
  if (zone.linear_speed) faults.check(*zone.linear_speed, kLinearSpeed, place + ".linear_speed");
  if (zone.angular_speed) faults.check(*zone.angular_speed, kAngularSpeed, place + ".angular_speed");
  faults.check(zone.heading, kAngle, place + ".heading");
  if (zone.type == Zone::Type::one_way) faults.check(zone.half_angle, kHalfAngle, place + ".half_angle");
  for (std::size_t k = 0; k < zone.robots.size(); ++k) {
    if (zone.robots[k] >= robots) faults.add(item(place + ".robots", k), "There is no such robot.");
  }
}

/// Returns a fault of the geometry in the words of the library.
Fault described(const core::ProblemFault& found) {
  using Kind = core::ProblemFault::Kind;
  const std::string robot = item("robots", found.robot);
  const std::string overlap = number_text(-found.gap) + " m";
  const std::string obstacle =
      found.zone ? "the blocked " + item("zones", *found.zone) : "a blocked cell or the edge of the map";
  const std::string disk = "The disk of radius " + number_text(found.radius) + " m overlaps ";
  switch (found.kind) {
    case Kind::start_in_obstacle:
      return {robot + ".start", disk + obstacle + " by " + overlap + '.'};
    case Kind::goal_in_obstacle:
      return {item(robot + ".goals", found.goal), disk + obstacle + " by " + overlap + '.'};
    case Kind::starts_overlap:
      return {robot + ".start",
              "It overlaps the start of " + item("robots", found.other) + " by " + overlap + '.'};
    case Kind::goals_overlap:
      return {robot + ".goals",
              "The last goal overlaps that of " + item("robots", found.other) + " by " + overlap + '.'};
    case Kind::committed_in_zone:
      return {robot + ".committed", "The motion breaks the rule of " + item("zones", *found.zone) + " at " +
                                        number_text(found.t) + " s."};
    case Kind::committed_collision:
      break;
  }
  const std::string other = found.other == found.robot ? obstacle : item("robots", found.other);
  return {robot + ".committed",
          "The motion meets " + other + " at " + number_text(found.t) + " s: an overlap of " + overlap + '.'};
}

core::ProblemConditions conditions(ReadFleet& fleet, const Options& options) {
  core::ProblemConditions made;
  made.pair_overlap = std::max(0.0, options.start_overlap - 2.0 * options.inflation);
  made.wall_overlap = std::max(0.0, options.start_overlap - options.inflation);
  made.obstacles = std::move(fleet.obstacles);
  made.zones = std::move(fleet.zones);
  return made;
}

}  // namespace

bool in_motion(const Problem& problem) {
  return std::any_of(problem.robots.begin(), problem.robots.end(),
                     [](const Robot& robot) { return !robot.committed.empty() || robot.previous; });
}

ReadFleet read_fleet(const Problem& problem) {
  const Frame frame(problem.map);
  FaultList faults(kMostFaults);
  ReadFleet read;
  for (std::size_t k = 0; k < problem.robots.size(); ++k) {
    const Robot& robot = problem.robots[k];
    const std::string place = item("robots", k);
    check_robot(robot, place, faults);
    core::Robot& made = read.robots.emplace_back(robot_of(robot, frame));
    made.committed =
        read_actions(robot.committed, made, robot.committed.size(), frame, place + ".committed", faults);
    if (robot.previous) {
      made.previous =
          read_actions(*robot.previous, made, robot.committed.size(), frame, place + ".previous", faults);
    }
    if (robot.idle == Robot::Idle::yield) made.let_yield();
    if (robot.idle == Robot::Idle::come_back && !made.goal) {
      made.goal = core::Goal{made.committed_end().position, made.committed_end().theta};
    }
  }
  for (std::size_t k = 0; k < problem.obstacles.size(); ++k) {
    check_obstacle(problem.obstacles[k], item("obstacles", k), faults);
    read.obstacles.push_back(obstacle_of(problem.obstacles[k], frame));
  }
  for (std::size_t k = 0; k < problem.zones.size(); ++k) {
    check_zone(problem.zones[k], problem.robots.size(), item("zones", k), faults);
    read.zones.push_back(zone_of(problem.zones[k], frame));
  }
  read.faults = faults.take();
  return read;
}

std::vector<Fault> faults_of(const Options& options, const Map& map) {
  FaultList faults(kMostFaults);
  if (options.time_budget.count() <= 0)
    faults.add("options.time_budget", "The time budget must be positive.");
  const auto interval = options.start_safe_interval.value_or(0.0);
  faults.check(interval, kDuration, "options.start_safe_interval");
  faults.check(options.inflation, kLengthOrZero, "options.inflation");
  faults.check(options.wait_before_move, kDuration, "options.wait_before_move");
  faults.check(options.interval_margin, kDuration, "options.interval_margin");
  faults.check(options.start_overlap, kLengthOrZero, "options.start_overlap");
  if (options.horizon) faults.check(*options.horizon, kHorizon, "options.horizon");
  const int c = options.connectivity;
  if (c != 4 && c != 8 && c != 16 && c != 32) {
    faults.add("options.connectivity", "The connectivity must be 4, 8, 16 or 32.");
  }
  if (options.max_iterations && *options.max_iterations < 0) {
    faults.add("options.max_iterations", "The number of steps must not be negative.");
  }
  if (!options.lattice_spacing) return faults.take();
  faults.check(*options.lattice_spacing, kLength, "options.lattice_spacing");
  if (!faults.empty()) return faults.take();
  constexpr std::int64_t kMostVertices = 1'000'000'000;
  const auto along = [&](int cells) {
    return core::Lattice::vertices_along(cells * map.resolution(), *options.lattice_spacing);
  };
  const std::int64_t columns = along(map.columns());
  const std::int64_t rows = along(map.rows());
  if (columns < 1 || rows < 1 || columns > kMostVertices / rows) {
    faults.add("options.lattice_spacing", "The lattice has no vertex on this map, or more than 1e9.");
  }
  return faults.take();
}

MadeProblem make_problem(const Problem& problem, const Options& options, const std::stop_token& stop) {
  ReadFleet fleet = read_fleet(problem);
  MadeProblem made;
  made.faults = std::move(fleet.faults);
  for (Fault& fault : faults_of(options, problem.map)) made.faults.push_back(std::move(fault));
  if (!made.faults.empty()) return made;
  const core::StopCondition cancelled(core::StopCondition::Clock::time_point::max(), stop);
  const auto map = core::static_map(grid_of(problem.map), cancelled);
  if (!map) return made;
  auto created = core::Problem::create(map, std::move(fleet.robots), conditions(fleet, options), cancelled);
  if (auto* valid = std::get_if<core::Problem>(&created)) {
    made.problem = std::move(*valid);
    return made;
  }
  const auto& faults = std::get<core::ProblemFaults>(created);
  if (!faults.finished) return made;
  for (const core::ProblemFault& found : faults.listed) made.faults.push_back(described(found));
  return made;
}

}  // namespace fleetplan::library

namespace fleetplan {

std::vector<Fault> faults_of(const Problem& problem, const Options& options) {
  return library::make_problem(problem, options, {}).faults;
}

InvalidProblem::InvalidProblem(std::vector<Fault> faults)
    : std::invalid_argument(faults.empty() ? "the problem is not valid"
                                           : faults.front().place + ": " + faults.front().detail),
      faults_(std::move(faults)) {}

}  // namespace fleetplan
