#pragma once

#include <fleetplan/options.h>
#include <fleetplan/plan.h>
#include <fleetplan/problem.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace fleetplan {

/// A violation of the rules by a plan. `distance` is the measured value. `required` is the limit or the
/// required value, in the unit that the kind names. All numbers are finite.
struct Violation {
  enum class Kind {
    robot_collision,     // two disks overlap: metres between the centres, and the sum of the radii
    obstacle_collision,  // a disk overlaps a blocked cell or leaves the map: metres to it, and the radius
    discontinuity,       // a gap in time or space, an action that contradicts its type, or a wrong cost
    speed,               // faster than the robot, or off the line of its heading
    profile,             // changes of speed that do not fit: a speed, seconds, metres or radians
    wrong_start,         // metres or radians from the start
    wrong_goal,          // metres or radians from the last goal, at rest
    wrong_visit,         // a goal that is not served in its order, in time and for its service
    committed_changed,   // the plan does not begin with the committed actions
    margin,              // robots pass within the interval margin: metres, and the sum of the radii
    moving_obstacle,     // a disk overlaps a moving obstacle: metres between the centres, sum of the radii
    zone,                // the rule of a zone is broken: metres, a speed or an angle
  };
  Kind kind = Kind::robot_collision;
  std::vector<std::size_t> robots = {};  // ascending; two for robot_collision and margin, one otherwise
  double t = 0.0;                        // seconds; of a collision, when the overlap is deepest
  double distance = 0.0;
  double required = 0.0;
  std::string detail = {};                   // a sentence for people, with units
  std::optional<std::size_t> obstacle = {};  // moving_obstacle: number of the obstacle
  std::optional<std::size_t> zone = {};      // zone: number of the zone
};

/// The options of the check. Rules that hold for every plan need no option. The default is the simplest
/// check.
struct Rules {
  /// How far plans may deviate, >= 0, in metres, seconds and radians. 1e-6 allows for decimal text.
  double tolerance = 1e-6;
  double inflation = 0.0;              // metres, as in Options
  double interval_margin = 0.0;        // seconds, as in Options
  double wait_before_move = 0.0;       // seconds, as in Options
  double start_overlap = 0.0;          // metres, as in Options
  double goal_overlap = 0.0;           // metres, as in Options
  std::optional<double> horizon = {};  // seconds, as in Options: plans that end later may end anywhere
  std::vector<UnavoidableCollision> unavoidable = {};  // collisions that are allowed, as in Plan
  std::vector<std::size_t> invalid = {};  // robots that stand at their starts, see Options::invalid_robots

  /// The time for the check. Thousands of robots that move in one small area may take minutes.
  std::chrono::nanoseconds time_budget = std::chrono::seconds(60);
  std::stop_token stop = {};
};

/// The outcome of a check.
struct Verification {
  bool finished = false;                   // false if the time budget ended, or a stop was requested
  std::vector<Violation> violations = {};  // by time; the first 10,000
  std::size_t violation_count = 0;         // number of all violations, listed or not
  /// Metres: the smallest gap between two disks over all time; none for fewer than two robots.
  std::optional<double> min_clearance = {};

  bool valid() const { return finished && violation_count == 0; }
};

/// Checks plans from any source, at most one for each robot and in any order. The check covers
///
/// - collisions of robots with robots, moving obstacles, walls and the edge of the map,
/// - the rules of zones,
/// - continuity and speeds,
/// - starts, visits, goals and commitments.
///
/// A robot without a plan executes its committed actions and stays at their end. The check is exact in
/// continuous time up to rounding. It shares no collision test with the search. Plans may leave out lower
/// bounds, visits and estimates.
///
/// The problem need not be valid as a whole: overlapping starts are violations at t = 0. But its numbers must
/// be in their ranges, and its lists as their types describe. Throws InvalidProblem otherwise. Throws
/// std::invalid_argument if
///
/// - a plan belongs to no robot,
/// - two plans belong to the same robot,
/// - a visit names a pose that its goal does not have,
/// - or an invalid robot does not exist.
Verification verify(const Problem& problem, std::span<const RobotPlan> plans, const Rules& rules = {});

/// Checks a plan of plan() for the same problem and options. The rules follow from the options, and the
/// plan's unavoidable collisions are allowed.
Verification verify(const Problem& problem, const Plan& plan, const Options& options = {});

}  // namespace fleetplan
