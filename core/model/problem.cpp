#include "core/model/problem.h"

#include <algorithm>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/map/line_of_sight.h"
#include "core/map/obstacle_distance.h"

namespace fleetplan::core {
namespace {

/// Finds the faults of robot after robot. Exact distances are computed only for faults that are listed.
class FaultSearch {
 public:
  FaultSearch(const OccupancyGrid& grid, const std::vector<Robot>& robots, bool of_every_robot,
              const StopCondition& stop)
      : grid_(grid), robots_(robots), stop_(stop), sight_(grid) {
    if (of_every_robot) listed_of_robot_.resize(robots.size(), 0);
  }

  ProblemFaults run() {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (stop_.met()) {
        faults_.finished = false;
        break;
      }
      check_obstacles(i);
      for (std::size_t j = 0; j < i; ++j) check_pair(j, i);
    }
    return std::move(faults_);
  }

 private:
  template <typename Gap>
  void add(ProblemFault::Kind kind, std::size_t robot, std::size_t other, const Gap& gap) {
    ++faults_.total;
    if (!is_listed(robot, is_of_a_pair(kind) ? other : robot)) return;
    faults_.listed.push_back({kind, robot, other, gap()});
  }

  static bool is_of_a_pair(ProblemFault::Kind kind) {
    return kind != ProblemFault::Kind::start_in_obstacle && kind != ProblemFault::Kind::goal_in_obstacle;
  }

  /// Whether a fault of these robots is listed; counts it.
  bool is_listed(std::size_t robot, std::size_t other) {
    if (listed_of_robot_.empty()) return faults_.listed.size() < ProblemFaults::kMostListed;
    std::size_t& of_robot = listed_of_robot_[robot];
    std::size_t& of_other = listed_of_robot_[other];
    if (std::min(of_robot, of_other) >= ProblemFaults::kMostListedOfARobot) return false;
    ++of_robot;
    if (other != robot) ++of_other;
    return true;
  }

  /// The start and the goal of a robot against obstacles and the edge of the map.
  void check_obstacles(std::size_t index) {
    const Robot& robot = robots_[index];
    if (robot.invalid) return;
    const auto check = [&](const Position& position, ProblemFault::Kind kind) {
      if (sight_.disk_fits(position, robot.radius - kContactTolerance + kSearchSlack)) return;
      add(kind, index, 0, [&] { return obstacle_distance(grid_, position, robot.radius) - robot.radius; });
    };
    check(robot.start.position, ProblemFault::Kind::start_in_obstacle);
    if (robot.goal) check(robot.goal->position, ProblemFault::Kind::goal_in_obstacle);
  }

  /// The starts and the goals of two robots against each other.
  void check_pair(std::size_t other, std::size_t index) {
    const Robot& a = robots_[other];
    const Robot& b = robots_[index];
    if (a.invalid && b.invalid) return;
    const double allowed = a.radius + b.radius - kContactTolerance;
    const auto check = [&](const Position& p, const Position& q, ProblemFault::Kind kind) {
      if (allowed <= 0.0 || (p - q).squaredNorm() >= allowed * allowed) return;
      add(kind, index, other, [&] { return (p - q).norm() - a.radius - b.radius; });
    };
    check(a.start.position, b.start.position, ProblemFault::Kind::starts_overlap);
    if (a.goal && b.goal) check(a.goal->position, b.goal->position, ProblemFault::Kind::goals_overlap);
  }

  const OccupancyGrid& grid_;
  const std::vector<Robot>& robots_;
  const StopCondition& stop_;
  const LineOfSight sight_;
  std::vector<std::size_t> listed_of_robot_;  // empty: the first faults of all are listed
  ProblemFaults faults_;
};

}  // namespace

Problem::Problem(OccupancyGrid grid, std::vector<Robot> robots, std::vector<MovingObstacle> obstacles)
    : grid_(std::move(grid)), robots_(std::move(robots)), obstacles_(std::move(obstacles)) {}

std::variant<Problem, ProblemFaults> Problem::create(OccupancyGrid grid, std::vector<Robot> robots,
                                                     ProblemConditions conditions,
                                                     const StopCondition& stop) {
  ProblemFaults faults = FaultSearch(grid, robots, conditions.list_faults_of_every_robot, stop).run();
  if (faults.total > 0 || !faults.finished) return faults;
  return Problem(std::move(grid), std::move(robots), std::move(conditions.obstacles));
}

}  // namespace fleetplan::core
