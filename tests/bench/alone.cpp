#include "tests/bench/alone.h"

#include <chrono>
#include <cstddef>
#include <numbers>
#include <vector>

#include "api/request/parse_request.h"
#include "core/compile/instance.h"
#include "core/fleet/plan_state.h"
#include "tests/bench/median.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::bench {
namespace {

double floor_share(const core::Problem& problem) {
  const core::OccupancyGrid& grid = problem.grid();
  int free = 0;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) free += grid.blocked({column, row}) ? 0 : 1;
  }
  double disks = 0.0;
  for (const core::Robot& robot : problem.robots()) disks += std::numbers::pi * robot.radius * robot.radius;
  return disks / (free * grid.resolution() * grid.resolution());
}

void plan_each_robot(const api::PlanRequest& request) {
  const auto never = core::StopCondition::never();
  const core::Instance instance(request.problem, request.options, never);
  core::PlanState state(instance);  // without reservations
  for (std::size_t robot = 0; robot < instance.size(); ++robot) {
    if (instance.problem().robots()[robot].goal) state.plan(robot, {}, never);
  }
}

}  // namespace

Alone plan_alone(const std::string& body, const api::Limits& limits, int repeats) {
  using Clock = std::chrono::steady_clock;
  const auto request = api::parse_request(body, limits, unbounded_work());
  std::vector<double> seconds;
  for (int run = 0; run < repeats; ++run) {
    const auto began = Clock::now();
    plan_each_robot(*request);
    seconds.push_back(std::chrono::duration<double>(Clock::now() - began).count());
  }
  return {median(seconds), floor_share(request->problem)};
}

}  // namespace fleetplan::bench
