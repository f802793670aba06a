#pragma once

// The input of a check (the fleet, the rules and the tolerances), and the violations that it finds.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"

namespace fleetplan::core {

/// How much the plan of one robot may deviate. Two disks may overlap by the larger of their tolerances.
struct Tolerance {
  double metres = 0.0;
  double seconds = 0.0;
  double radians = 0.0;

  static Tolerance of_all(double tolerance) { return {tolerance, tolerance, tolerance}; }
};

/// No tolerance in metres exceeds this, whatever a request contains. Also the default of POST /v1/validate.
inline constexpr double kMaxTolerance = 1e-6;

/// Returns, by robot, the tolerances for a plan of the planner. They allow for contact and for the rounding
/// of doubles. Rounding grows with coordinates (the map's size) and times (the length of the robot's plan, at
/// its own speed). For robots with actions from the request, kMaxTolerance.
std::vector<Tolerance> plan_tolerances(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                       const std::vector<RobotPlan>& plans);

/// The map, the robots, the moving obstacles and the zones of a request. They need not form a valid Problem.
struct CheckedFleet {
  const OccupancyGrid& grid;
  const std::vector<Robot>& robots;
  const std::vector<MovingObstacle>& obstacles;
  const std::vector<Zone>* zones = nullptr;  // null: none
};

/// Whether a plan may end with goals left, because it ends at or after the horizon.
enum class GoalsLeft : std::uint8_t { none, allowed };

/// The options of a check. Rules that hold for every plan need no option. The default is the simplest check.
struct CheckRules {
  std::vector<Tolerance> tolerances;  // by robot
  /// Metres added to all radii, against robots and walls, except while robots execute commitments.
  double inflation = 0.0;
  double interval_margin = 0.0;   // seconds, see PlanOptions
  double wait_before_move = 0.0;  // seconds: every translation follows a stand-still of this duration
  /// Metres by which robots may overlap each other or a wall at their start, inflation included.
  double start_overlap = 0.0;
  /// Metres by which robots may overlap a wall at their last goal and in their commitment, inflation
  /// included. So the same overlap is allowed at their start.
  double goal_overlap = 0.0;
  /// Seconds: a plan that ends at this time or later may end anywhere, with goals left. nullopt: all plans
  /// lead to the goal.
  std::optional<double> horizon = {};
  /// Committed actions must be repeated to the last digit. Otherwise the tolerances apply.
  bool exact_commitments = false;
  /// Unavoidable collisions that are allowed. Each exempts exactly its pair, during the one uninterrupted
  /// overlap that contains UnavoidableCollision::t. The overlap is of the bare disks, and contact counts.
  std::vector<UnavoidableCollision> exempt = {};

  /// Metres by which robots may overlap at their start, by both options.
  double overlap_at_start() const { return std::max(start_overlap, goal_overlap); }
};

/// The maximum number of overlaps of robots in a report. Many robots in one place have millions of overlaps.
inline constexpr std::size_t kMaxCollisions = 10'000;

/// The maximum number of violations in a report. Every action may have several.
inline constexpr std::size_t kMaxViolations = 10'000;

/// A violation of the rules by a plan. All numbers are finite.
///
/// The kinds, and what `distance` and `required` are:
///
/// - robot_collision: two disks overlap. One violation for each uninterrupted overlap. The distance of the
///   centres, and the sum of the radii.
/// - obstacle_collision: a disk overlaps a blocked cell or leaves the map. One violation for each action, or
///   for consecutive actions through which the overlap continues. The distance from the centre to the
///   obstacle (0: inside), and the radius.
/// - discontinuity: a gap in time or position, an action that contradicts its type, or a cost other than the
///   last t_end. The gap or jump, and 0; or a time, and the required time. Also a number that is not finite
///   or beyond 1e30; then the robot is not checked any further.
/// - speed: faster than the robot. The speed, and the robot's speed. For an action without duration, the
///   duration, and the shortest possible one. Also a translation that leads off the line of its heading
///   (forwards or backwards): by how many metres, and 0.
/// - profile: a robot with limited acceleration has no profile of speed, or a wrong one. The robot cannot
///   follow it, or it does not lead from one pose to the other. A speed, and the required speed. Or the
///   length (or angle) that the profile covers, and the length of the action. Or a duration, and the shortest
///   possible one.
/// - wrong_start, wrong_goal: the distance of the first or the resting pose from the required pose, and 0.
///   Parked robots must rest at their start or committed end, in any heading. A robot without a plan is
///   unplanned, which is allowed.
/// - wrong_visit: a goal is not served in its order, in time and for its service. Or a plan, or the `goal` of
///   a wait, claims a visit that does not take place. A time, and the required time; or how far the robot
///   rests from the goal, and 0.
/// - committed_changed: a plan does not begin with the committed actions. By how much the first different
///   number differs, and 0; or the number of actions, and of committed actions.
/// - margin: a robot passes a place where another robot is up to the interval margin earlier or later. The
///   distance of the centres, and the sum of the radii.
/// - moving_obstacle: a disk overlaps a moving obstacle. One violation for each uninterrupted overlap. The
///   distance of the centres, and the sum of the radii.
/// - zone, blocked: a disk overlaps the zone. One violation for each uninterrupted overlap. The distance from
///   the centre to the zone (0: inside), and the radius.
/// - zone, speed and one-way: the rule of the zone is broken. One violation for each action whose centre is
///   deeper inside than the tolerance. Its speed, and the greatest allowed speed; or the angle between its
///   direction and the heading, and the greatest allowed angle.
struct Violation {
  enum class Kind {
    robot_collision,
    obstacle_collision,
    discontinuity,
    speed,
    profile,
    wrong_start,
    wrong_goal,
    wrong_visit,
    committed_changed,
    margin,
    moving_obstacle,
    zone,
  };
  Kind kind;
  std::vector<std::size_t> robots;  // indices, ascending; two for robot_collision and margin, one otherwise
  double t = 0.0;                   // seconds; of a collision, the first time at which the overlap is deepest
  double distance = 0.0;            // measured: metres, radians, seconds or metres (radians) per second
  double required = 0.0;            // the limit or required value, same unit
  std::string detail;               // a sentence for people, with units; names no robots by index
  std::optional<std::size_t> obstacle = {};  // moving_obstacle: index of the obstacle
  std::optional<double> t_begin = {};        // robot_collision: when the overlap begins, seconds
  std::optional<std::size_t> zone = {};      // zone: index of the zone
};

/// Violations. The first kMaxViolations by time, then kind, then robots, are kept. All are counted.
class ViolationList {
 public:
  void add(Violation violation);
  void add(ViolationList more);

  std::size_t total() const { return total_; }
  /// Returns the violations that are kept, in order, and empties the list.
  std::vector<Violation> take();

 private:
  void keep(Violation violation);
  void sort_and_cut();

  std::vector<Violation> kept_;  // at most twice as many as are kept in the end
  bool was_cut_ = false;         // the first kMaxViolations are in order; later ones are not wanted
  std::size_t total_ = 0;
};

/// Returns a number with its unit, for the details of violations.
inline std::string quantity_text(double value, const char* unit) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.6g %s", value, unit);
  return text.data();
}

inline std::string metres(double value) { return quantity_text(value, "m"); }
inline std::string seconds(double value) { return quantity_text(value, "s"); }
inline std::string radians(double value) { return quantity_text(value, "rad"); }

}  // namespace fleetplan::core
