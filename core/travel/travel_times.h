#pragma once

// How long a robot takes from pose to pose, alone on the map, and when it would arrive at the ends of tasks.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What one robot needs for a way.
struct Travel {
  double seconds = 0.0;  // until it rests in the pose at the end, rotations included
  double metres = 0.0;
};

/// The ways that are asked for: from where each robot of a problem begins to one of these goals.
struct TravelQuestions {
  struct Column {
    Goal goal;
    std::vector<std::size_t> robots;  // that come from their starts
  };
  std::vector<bool> any_heading;  // by robot: it begins in the heading that suits it best
  std::vector<Column> columns;
};

/// By column, then as in Column::robots; none where there is no way.
using TravelAnswers = std::vector<std::vector<std::optional<Travel>>>;

/// Returns the fastest ways that the planner knows, for similar robots that are on the map one at a time
/// (ProblemConditions). The goals of the problem's own robots do not matter. None if `stop` is met first, or
/// if `go_on`, which may be empty, ends it (SharedTurn).
///
/// A way consists of straight moves between the vertices of the robot's lattice, its start and the goal. The
/// result is the faster of two ways:
///
/// - The way of a backward search from the goal (CostToGo). All ways to this goal share the search, and its
///   estimates do not depend on the others.
/// - The way of the planner's own search (AaSipp) with these estimates, a heuristic weight of 1 and no
///   accepted suboptimality. This search knows more headings.
std::optional<TravelAnswers> travel_times(const Problem& problem, const PlanOptions& options,
                                          const TravelQuestions& questions, const StopCondition& stop,
                                          Executor& executor, const std::function<bool()>& go_on);

/// Goals that one robot is to visit in their order, after its own goals.
struct Task {
  std::vector<Goal> goals;          // at least one
  std::vector<std::size_t> robots;  // that may do it, ascending
};

/// Returns when robots would rest in the last pose of tasks, by task, then as in Task::robots: seconds, or
/// kForever if there is no way. Each robot is alone. After its committed actions, it visits the goals that
/// are left to it, and then the goals of the task.
///
/// Services and `not_before` count. Ways take their travel_times(), so a robot leaves a goal without a
/// heading in any heading. None if `stop` is met first, or if `go_on` ends it, see travel_times().
std::optional<std::vector<std::vector<double>>> arrivals(const Problem& problem, const PlanOptions& options,
                                                         const std::vector<Task>& tasks,
                                                         const StopCondition& stop, Executor& executor,
                                                         const std::function<bool()>& go_on);

}  // namespace fleetplan::core
