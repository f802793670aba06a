#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A reason why a map and a set of robots are not a valid problem.
struct ProblemFault {
  enum class Kind {
    start_in_obstacle,  // the robot's disk at its start overlaps a blocked cell or leaves the map
    goal_in_obstacle,   // likewise at its goal
    starts_overlap,     // the starts of `robot` and `other` (< robot) overlap
    goals_overlap,      // the goals of `robot` and `other` (< robot) overlap
  };
  Kind kind = Kind::start_in_obstacle;
  std::size_t robot = 0;
  std::size_t other = 0;  // pairs only
  double gap = 0.0;       // metres, negative: the overlap of the disks, or of the disk and the obstacle
};

/// The faults of a map and a set of robots.
struct ProblemFaults {
  static constexpr std::size_t kMostListed = 20;
  std::vector<ProblemFault> listed;  // the first ones, in the order of the robots
  std::size_t total = 0;
  bool finished = true;  // false when the stop condition was met first; then there may be more
};

/// A map and robots that can be planned for. A problem that exists is valid: radii and speeds are positive
/// and finite, every start and goal is clear of obstacles by the bare radius, no two starts and no two goals
/// overlap (by more than kContactTolerance). The planner relies on this and does not check it again.
class Problem {
 public:
  /// The problem, or its faults. `robots` have positive finite radii and speeds.
  static std::variant<Problem, ProblemFaults> create(OccupancyGrid grid, std::vector<Robot> robots,
                                                     const StopCondition& stop = {});

  const OccupancyGrid& grid() const { return grid_; }
  const std::vector<Robot>& robots() const { return robots_; }

 private:
  Problem(OccupancyGrid grid, std::vector<Robot> robots);

  OccupancyGrid grid_;
  std::vector<Robot> robots_;
};

}  // namespace fleetplan::core
