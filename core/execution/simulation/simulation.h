#pragma once

// A Monte-Carlo study: a plan is executed many times with different disturbances, in continuous time and
// without time steps. Each execution is checked by the formulas of the checker.
//
// A run ends when no robot can go on, which its policy decides:
//
// - `open_loop`, `absorb_waits`: when each robot has executed all of its actions (`execute_alone` in
//   execution_policy.cpp).
// - `dependencies`: when no robot is ready to go on and no event of a drive is left
//   (`DependentExecution::run` in execute_dependencies.cpp). A robot that still has actions then waits for
//   ever and has not arrived: a deadlock.
// - `clock_stop`: when every robot has ended the last phase of its last action (`ClockedExecution::run` in
//   execute_with_clock.cpp). All robots arrive.
//
// A robot's end is the last knot of its progress (`ExecutedProgress::end`): it has executed its last action,
// or waits for ever. It rests there. So the check of a run covers all time, without an end (`executed_legs`).
// A run that the stop condition ends has no outcome and does not count.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/execution/simulation/disturbance.h"
#include "core/execution/simulation/execution_policy.h"
#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/distances.h"

namespace fleetplan::core {

/// One uninterrupted overlap of two disks, or of a disk and a wall (or the edge of the map).
struct ExecutedCollision {
  std::size_t first = 0;              // index of a robot
  std::optional<std::size_t> second;  // index of another robot, > first; nullopt: a wall
  double t = 0.0;               // seconds: when the overlap begins; with a wall, when it is deepest in a leg
  Position position{0.0, 0.0};  // the middle of the two centres at `t`, or with a wall the centre
  double depth = 0.0;           // metres: the largest overlap
};

struct ExecutionCollisions {
  std::optional<ExecutedCollision> first;                  // the earliest one
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // robots that collide, ascending
};

/// Finds the collisions of robots. `legs` and `radii` (metres) are by robot. Disks may overlap each other and
/// walls by `tolerance` metres. Only the robots of `near_walls` are compared with the walls. Returns none if
/// `stop` is met first.
std::optional<ExecutionCollisions> find_collisions(const std::vector<std::vector<Leg>>& legs,
                                                   const std::vector<double>& radii, double tolerance,
                                                   const ObstacleField& field,
                                                   const std::vector<std::size_t>& near_walls,
                                                   const StopCondition& stop);

/// Returns the first overlap of one robot and a wall, in the order of the legs. None if `stop` is met first.
std::optional<ExecutedCollision> find_wall(const ObstacleField& field, std::size_t robot,
                                           const std::vector<Leg>& legs, double radius, double tolerance,
                                           const StopCondition& stop);

/// The fleet and the execution to study. A robot without a plan executes its committed actions and stays at
/// their end.
struct SimulatedFleet {
  const OccupancyGrid& grid;
  const std::vector<Robot>& robots;
  std::vector<double> body_radii;  // metres, by robot
  PlannedExecution execution;
};

/// Appends plans of the committed actions of robots that have no plan.
void add_commitments(const std::vector<Robot>& robots, std::vector<RobotPlan>& plans);

/// Returns the execution of plans by a policy. `wait_before_move`: PlanOptions::wait_before_move in seconds.
/// The robots of the dependencies are indices of robots.
PlannedExecution planned_execution(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans,
                                   ExecutionPolicy policy, double max_delay, double wait_before_move,
                                   std::vector<Dependency> dependencies);

struct SimulationSettings {
  Disturbance disturbance;
  std::size_t runs = 1;
  std::uint64_t seed = 0;
};

/// Executes and checks one run after the other, in any order and by any thread.
class Simulator {
 public:
  /// The outcome of one run.
  struct Run {
    std::vector<double>
        ends;  // seconds, by plan: when its robot arrived; if it has not arrived, its last moment
    std::vector<std::size_t> stuck;  // plans whose robots wait for ever, ascending
    ExecutionCollisions collisions;
  };
  /// Prepares the runs: compares the planned paths with the walls. Returns none if `stop` is met first. The
  /// fleet must outlive the object.
  static std::optional<Simulator> make(const SimulatedFleet& fleet, const SimulationSettings& settings,
                                       const StopCondition& stop);

  /// Executes and checks run number `number`. Returns none if `stop` is met first.
  std::optional<Run> run(std::uint64_t number, const StopCondition& stop) const;

 private:
  Simulator(const SimulatedFleet& fleet, const SimulationSettings& settings);

  const SimulatedFleet& fleet_;
  SimulationSettings settings_;
  ObstacleField field_;
  std::vector<std::vector<Leg>> resting_;  // by robot: the legs of a robot without a plan; empty for others
  std::vector<std::size_t> near_walls_;    // robots that may touch a wall
};

/// Executes runs `begin`, ..., `end` - 1 in rounds, and calls `add` with each in this order. Ends early when
/// `stop` is met, or when `go_on`, which is called before each round, returns false. The executor's threads
/// help; what `add` gets does not depend on their number. Returns the number of the first run that it did not
/// get.
std::size_t run_in_rounds(const Simulator& simulator, std::size_t begin, std::size_t end,
                          const StopCondition& stop, Executor& executor,
                          const std::function<void(const Simulator::Run&)>& add,
                          const std::function<bool()>& go_on);

/// One run in detail: the actions that were executed, by plan.
struct SimulationTrace {
  std::vector<std::vector<Action>> actions;
};

/// Executes one run and returns the actions. None if there are more than `max_actions`, or if `stop` is met
/// first.
std::optional<SimulationTrace> trace_run(const SimulatedFleet& fleet, const SimulationSettings& settings,
                                         std::uint64_t number, std::size_t max_actions,
                                         const StopCondition& stop);

/// Progress of a study.
struct SimulationProgress {
  std::size_t done = 0;  // runs that are done
  std::size_t runs = 0;  // runs that were asked for
  std::size_t collided = 0;
  std::size_t deadlocked = 0;
};

/// The figures of a study. They depend only on the fleet, the settings and the number of runs.
struct SimulationReport {
  struct Numbered {
    std::size_t run = 0;
    ExecutedCollision collision;
  };
  struct Deadlock {
    std::size_t run = 0;
    std::vector<std::size_t> plans;  // plans whose robots wait for ever
  };
  struct Pair {
    std::size_t first = 0;  // index of a robot
    std::size_t second = 0;
    std::size_t runs = 0;  // number of runs in which they collide
  };
  static constexpr std::size_t kMaxListed = 20;

  SimulationProgress totals;
  std::vector<double> flowtimes;  // seconds, in the runs in which all robots arrive
  std::vector<double> makespans;  // seconds, in the runs in which all robots arrive
  std::vector<std::vector<double>>
      delays;  // by plan: seconds behind its cost, in the runs in which its robot arrives
  std::vector<Numbered> first_collisions;  // the first runs with a collision
  std::vector<Deadlock> deadlocks;         // the first runs with a deadlock
  std::vector<Pair> pairs;                 // the pairs that collide in most runs, ties by robots
};

/// Executes runs 0, 1, ... until all of them are done, `stop` is met, or `go_on` returns false. `go_on` is
/// called from time to time. The report contains the runs before the first run that is not done. The
/// executor's threads help; the figures do not depend on their number.
SimulationReport simulate(const SimulatedFleet& fleet, const SimulationSettings& settings,
                          const StopCondition& stop, Executor& executor,
                          const std::function<bool(const SimulationProgress&)>& go_on = {});

}  // namespace fleetplan::core
