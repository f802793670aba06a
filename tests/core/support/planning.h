#pragma once

// A problem with its instance and plan state, ready for searches.

#include <string>
#include <utility>
#include <vector>

#include "core/bounds/lower_bound.h"
#include "core/compile/instance.h"
#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/moves/fleet_steps.h"
#include "core/runtime/executor.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/aa_sipp.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {

/// Limits for a search with exact dominance that returns the cheapest path that it can find.
inline constexpr SearchSettings kExact{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};

struct Planning {
  explicit Planning(Problem given, const PlanOptions& options = {})
      : problem(std::move(given)),
        instance(problem, options, StopCondition::never()),
        state(instance),
        random(options.seed) {}
  Planning(OccupancyGrid grid, std::vector<Robot> robots, const PlanOptions& options = {})
      : Planning(support::make_problem(std::move(grid), std::move(robots)), options) {}
  Planning(const Planning&) = delete;
  Planning& operator=(const Planning&) = delete;

  /// Robots with goals, ascending.
  std::vector<std::size_t> movers() const {
    std::vector<std::size_t> movers;
    for (std::size_t i = 0; i < instance.size(); ++i) {
      if (!instance.itinerary(i).is_parked()) movers.push_back(i);
    }
    return movers;
  }

  Problem problem;
  Instance instance;
  PlanState state;
  FleetReservations& reservations{state.reservations()};
  Random random;
  StopCondition never = StopCondition::never();
  CallerThread callers_thread;
  ProgressReport progress{reservations, nullptr};  // no observer
  FleetSteps steps{reservations, random, progress};
};

/// The lower bound of a robot with a goal, obstacles ignored.
inline double straight_bound(const Instance& instance, std::size_t robot) {
  const Itinerary& itinerary = instance.itinerary(robot);
  return lower_bound(itinerary, instance.views(robot).bodies(itinerary.goals.size()));
}

/// Robot 0 has to cross the middle of a hall, where robot 1 is.
struct CrossedHall : Planning {
  CrossedHall()
      : Planning(OccupancyGrid(9, 5, 1.0),
                 {support::robot_at(0.5, 2.5).to(8.5, 2.5), support::robot_at(4.5, 2.5).to(4.5, 4.5)}) {}
};

/// A stop condition that is met.
inline StopCondition met() {
  std::stop_source source;
  source.request_stop();
  return StopCondition(StopCondition::Clock::time_point::max(), source.get_token());
}

/// Straight moves through these points at 1 m/s without waits in between; the first departs at `departure`.
inline Trajectory through(const std::vector<Position>& points, double departure = 0.0) {
  Trajectory trajectory{points.front(), {}, departure};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double arrival = trajectory.cost + (points[i] - points[i - 1]).norm();
    trajectory.moves.push_back({{{points[i - 1], points[i]}, trajectory.cost, arrival}});
    trajectory.cost = arrival;
  }
  return trajectory;
}

/// A single long path back and forth, 28 m x 9 m.
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
