#include "core/model/problem.h"

#include <utility>

#include "core/geometry/tolerance.h"
#include "core/map/line_of_sight.h"
#include "core/map/obstacle_distance.h"

namespace fleetplan::core {
namespace {

using Faults = std::vector<ProblemFault>;

/// Limits the memory: a hostile request can contain millions of faults.
constexpr std::size_t kMaxFaults = 1000;

/// The start and the goal of a robot against obstacles and the edge of the map.
Faults obstacle_faults(const OccupancyGrid& grid, const LineOfSight& sight, const Robot& robot,
                       std::size_t index) {
  Faults faults;
  const auto check = [&](const Position& position, ProblemFault::Kind kind) {
    if (sight.disk_fits(position, robot.radius)) return;  // quick, whatever the radius
    const double gap = obstacle_distance(grid, position, robot.radius) - robot.radius;
    if (gap < -kContactTolerance) faults.push_back({kind, index, 0, gap});
  };
  check(robot.start.position, ProblemFault::Kind::start_in_obstacle);
  if (robot.goal) check(robot.goal->position, ProblemFault::Kind::goal_in_obstacle);
  return faults;
}

/// The starts and the goals of two robots against each other.
Faults overlap_faults(const std::vector<Robot>& robots, std::size_t other, std::size_t index) {
  Faults faults;
  const Robot& a = robots[other];
  const Robot& b = robots[index];
  const auto check = [&](const Position& p, const Position& q, ProblemFault::Kind kind) {
    const double gap = (p - q).norm() - a.radius - b.radius;
    if (gap < -kContactTolerance) faults.push_back({kind, index, other, gap});
  };
  check(a.start.position, b.start.position, ProblemFault::Kind::starts_overlap);
  if (a.goal && b.goal) check(a.goal->position, b.goal->position, ProblemFault::Kind::goals_overlap);
  return faults;
}

Faults faults_of(const OccupancyGrid& grid, const std::vector<Robot>& robots) {
  Faults faults;
  const auto append = [&](const Faults& more) { faults.insert(faults.end(), more.begin(), more.end()); };
  const LineOfSight sight(grid);
  for (std::size_t i = 0; i < robots.size() && faults.size() < kMaxFaults; ++i) {
    append(obstacle_faults(grid, sight, robots[i], i));
    for (std::size_t j = 0; j < i && faults.size() < kMaxFaults; ++j) append(overlap_faults(robots, j, i));
  }
  return faults;
}

}  // namespace

Problem::Problem(OccupancyGrid grid, std::vector<Robot> robots)
    : grid_(std::move(grid)), robots_(std::move(robots)) {}

std::variant<Problem, std::vector<ProblemFault>> Problem::create(OccupancyGrid grid,
                                                                 std::vector<Robot> robots) {
  Faults faults = faults_of(grid, robots);
  if (!faults.empty()) return faults;
  return Problem(std::move(grid), std::move(robots));
}

}  // namespace fleetplan::core
