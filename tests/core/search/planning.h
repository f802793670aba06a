#pragma once

// A problem with everything that the search needs around it.

#include <string>
#include <utility>
#include <vector>

#include "core/parallel/executor.h"
#include "core/search/aa_sipp.h"
#include "core/search/fleet.h"
#include "core/search/fleet_state.h"
#include "core/search/progress_report.h"
#include "core/search/random.h"
#include "core/search/stop_condition.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {

/// A search that settles for nothing dearer than it has to.
inline constexpr SearchLimits kExact{
    .greed = 1.0, .suboptimality = 0.0, .impatience = 0.0, .coarseness = 0.0};

struct Planning {
  explicit Planning(Problem told, const PlanOptions& options = {})
      : problem(std::move(told)), fleet(problem, options), state(fleet), random(options.seed) {}
  Planning(OccupancyGrid grid, std::vector<Robot> robots, const PlanOptions& options = {})
      : Planning(support::make_problem(std::move(grid), std::move(robots)), options) {}
  Planning(const Planning&) = delete;
  Planning& operator=(const Planning&) = delete;

  /// Robots with goals, ascending.
  std::vector<std::size_t> movers() const {
    std::vector<std::size_t> movers;
    for (std::size_t i = 0; i < fleet.size(); ++i) {
      if (fleet.robot(i).goal) movers.push_back(i);
    }
    return movers;
  }

  Problem problem;
  Fleet fleet;
  FleetState state;
  Random random;
  StopCondition never;
  CallersThread callers_thread;
  ProgressReport progress{state, nullptr};  // nobody watches
};

/// A stop condition that is met already.
inline StopCondition met() {
  std::stop_source source;
  source.request_stop();
  return StopCondition(StopCondition::Clock::time_point::max(), source.get_token());
}

/// Straight moves through these points, each at a speed of 1 m/s and departing as soon as it can, the first
/// at `departure`.
inline Trajectory through(const std::vector<Position>& points, double departure = 0.0) {
  Trajectory trajectory{points.front(), {}, departure};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double arrival = trajectory.cost + (points[i] - points[i - 1]).norm();
    trajectory.moves.push_back({{points[i - 1], points[i]}, trajectory.cost, arrival});
    trajectory.cost = arrival;
  }
  return trajectory;
}

/// One way back and forth, 28 m x 9 m; no search finds it at a glance.
inline OccupancyGrid maze() {
  return support::ascii_map({"............................",  //
                             "............................",  //
                             ".###########################",  //
                             "............................",  //
                             "###########################.",  //
                             "............................",  //
                             ".###########################",  //
                             "............................",  //
                             "............................"});
}

}  // namespace fleetplan::core
