#include "core/model/problem.h"

#include <utility>

#include "core/geometry/tolerance.h"
#include "core/map/line_of_sight.h"
#include "core/map/obstacle_distance.h"

namespace fleetplan::core {
namespace {

/// Nobody reads more, and a hostile request could ask for millions.
constexpr std::size_t kMaxFaults = 1000;

void check_obstacles(const OccupancyGrid& grid, const LineOfSight& sight, const Robot& robot,
                     std::size_t index, std::vector<ProblemFault>& faults) {
  const auto check = [&](const Position& position, ProblemFault::Kind kind) {
    if (sight.disk_fits(position, robot.radius)) return;  // quick, whatever the radius
    const double gap = obstacle_distance(grid, position, robot.radius) - robot.radius;
    if (gap < -kContactTolerance) faults.push_back({kind, index, 0, gap});
  };
  check(robot.start.position, ProblemFault::Kind::start_in_obstacle);
  if (robot.goal) check(robot.goal->position, ProblemFault::Kind::goal_in_obstacle);
}

void check_pair(const std::vector<Robot>& robots, std::size_t other, std::size_t index,
                std::vector<ProblemFault>& faults) {
  const Robot& a = robots[other];
  const Robot& b = robots[index];
  const auto check = [&](const Position& p, const Position& q, ProblemFault::Kind kind) {
    const double gap = (p - q).norm() - a.radius - b.radius;
    if (gap < -kContactTolerance) faults.push_back({kind, index, other, gap});
  };
  check(a.start.position, b.start.position, ProblemFault::Kind::starts_overlap);
  if (a.goal && b.goal) check(a.goal->position, b.goal->position, ProblemFault::Kind::goals_overlap);
}

}  // namespace

Problem::Problem(OccupancyGrid grid, std::vector<Robot> robots)
    : grid_(std::move(grid)), robots_(std::move(robots)) {}

std::variant<Problem, std::vector<ProblemFault>> Problem::create(OccupancyGrid grid,
                                                                 std::vector<Robot> robots) {
  std::vector<ProblemFault> faults;
  const LineOfSight sight(grid);
  for (std::size_t i = 0; i < robots.size() && faults.size() < kMaxFaults; ++i) {
    check_obstacles(grid, sight, robots[i], i, faults);
    for (std::size_t j = 0; j < i && faults.size() < kMaxFaults; ++j) check_pair(robots, j, i, faults);
  }
  if (!faults.empty()) return faults;
  return Problem(std::move(grid), std::move(robots));
}

}  // namespace fleetplan::core
