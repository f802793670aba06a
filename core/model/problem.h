#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/map/static_map.h"
#include "core/model/plan_options.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/model/ways_out.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A reason why a map and a set of robots are not a valid problem.
struct ProblemFault {
  enum class Kind {
    start_in_obstacle,  // the robot's disk at its start overlaps a blocked cell or zone, or leaves the map
    goal_in_obstacle,   // the robot's disk at a goal overlaps a blocked cell or zone, or leaves the map
    starts_overlap,     // the starts of `robot` and `other` (< robot) overlap
    goals_overlap,      // the last goals of `robot` and `other` (< robot) overlap, and neither yields
    /// The committed motion of `robot`, to its own end, collides with one of these:
    ///
    /// - the committed motion of another robot, or a robot that stands at its start,
    /// - a wall, a blocked zone or the edge of the map.
    committed_collision,
    committed_in_zone,  // the committed motion of `robot` breaks the rule of `zone`, which is not blocked
  };
  Kind kind = Kind::start_in_obstacle;
  std::size_t robot = 0;
  std::size_t other = 0;  // pairs only; for committed_collision with a wall, the robot itself
  double gap = 0.0;       // metres, negative: the overlap of the disks, or of the disk and the obstacle
  std::size_t goal = 0;   // goal_in_obstacle: number of the goal
  double t = 0.0;         // committed_collision and committed_in_zone: seconds
  double radius = 0.0;    // metres, of the disk that does not fit at a start or goal
  std::optional<std::size_t> zone = {};  // index of the zone that is the obstacle, or whose rule is broken
};

/// The faults of a map and a set of robots.
struct ProblemFaults {
  static constexpr std::size_t kMaxListed = 20;
  static constexpr std::size_t kMaxListedOfARobot = 3;  // see ProblemConditions
  std::vector<ProblemFault> listed;                     // the first ones, in the order of the robots
  std::size_t total = 0;
  bool finished = true;  // false when the stop condition was met first; then there may be more
};

/// How far the starts and last goals of a problem may overlap, the moving obstacles, and the zones.
struct ProblemConditions {
  std::vector<MovingObstacle> obstacles = {};
  std::vector<Zone> zones = {};
  /// Metres: how far two bare disks, or a bare disk and a wall, may overlap at the start. 0: contact only.
  double pair_overlap = 0.0;
  double wall_overlap = 0.0;
  /// Metres: how far a bare disk may overlap a wall at the last goal, where it stays. The same holds in
  /// committed motion, which may lead there. 0: contact only.
  double wall_overlap_at_goal = 0.0;
  double inflation = 0.0;  // metres, of the plan: with it, robots leave zones and are clear of them
  /// Each robot is alone on the map, because the others are there at other times. Robots are not compared.
  bool one_at_a_time = false;
  /// Lists the first faults of every robot, instead of the first faults of all robots.
  bool list_faults_of_every_robot = false;
};

/// Returns the conditions that follow from options: how far starts and last goals may overlap, and the
/// inflation.
ProblemConditions conditions_of(const PlanOptions& options);

/// A map and robots that can be planned for. A problem that exists is valid:
///
/// - Radii and speeds are positive and finite.
/// - Every start and goal is clear of obstacles by the bare radius.
/// - No two starts and no two last goals overlap by more than kContactTolerance, or than the conditions
///   allow.
/// - Committed motion collides with nothing that is certain.
///
/// The planner relies on this and does not check it again. Robots with Robot::invalid are exempt. Starts,
/// goals and committed motion may be inside zones that may be left (Zone::may_leave). Goals that are put off
/// are not among the goals of the problem's robots (PostponedGoals).
class Problem {
 public:
  /// Returns the problem, or its faults. `robots` have positive finite radii and speeds.
  static std::variant<Problem, ProblemFaults> create(OccupancyGrid grid, std::vector<Robot> robots,
                                                     const StopCondition& stop) {
    return create(std::move(grid), std::move(robots), {}, stop);
  }
  static std::variant<Problem, ProblemFaults> create(OccupancyGrid grid, std::vector<Robot> robots,
                                                     ProblemConditions conditions, const StopCondition& stop);
  static std::variant<Problem, ProblemFaults> create(std::shared_ptr<const StaticMap> map,
                                                     std::vector<Robot> robots, ProblemConditions conditions,
                                                     const StopCondition& stop);

  /// The static map without zones; never null.
  const std::shared_ptr<const StaticMap>& map() const { return maps_.map(); }
  /// The static map with the zones that are blocked for the robot; never null.
  const std::shared_ptr<const StaticMap>& map_of(std::size_t robot) const { return maps_.of(robot); }
  const OccupancyGrid& grid() const { return map()->grid(); }
  const std::vector<Robot>& robots() const { return robots_; }
  const std::vector<MovingObstacle>& obstacles() const { return obstacles_; }
  const std::vector<Zone>& zones() const { return zones_; }
  /// Whether each robot is alone on the map, see ProblemConditions.
  bool one_at_a_time() const { return one_at_a_time_; }
  /// What zones that may be left change for a robot; null if they change nothing.
  const Leaving* leaving(std::size_t robot) const { return leaving_.empty() ? nullptr : &leaving_[robot]; }

 private:
  Problem(ZoneMaps maps, std::vector<Robot> robots, ProblemConditions conditions,
          std::vector<Leaving> leaving);

  ZoneMaps maps_;
  std::vector<Robot> robots_;
  std::vector<MovingObstacle> obstacles_;
  std::vector<Zone> zones_;
  std::vector<Leaving> leaving_;  // by robot, or none
  bool one_at_a_time_;
};

}  // namespace fleetplan::core
