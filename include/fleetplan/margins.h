#pragma once

#include <fleetplan/options.h>
#include <fleetplan/plan.h>
#include <fleetplan/planner.h>
#include <fleetplan/problem.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fleetplan {

/// How robots execute their plans: docs/endpoints.md, Simulation.
enum class ExecutionPolicy {
  open_loop,     // every action lasts its planned time, disturbed
  absorb_waits,  // waits end at their planned time, or at once if that has passed
  dependencies,  // robots wait for each other, by FoundMargins::dependencies
  clock_stop,    // all follow one clock, which slows down for robots that are late
};

/// What delays robots, and how far they drive beside their ways. The default disturbs nothing.
struct Disturbance {
  /// A uniform distribution; min <= max.
  struct Range {
    double min = 1.0;
    double max = 1.0;
  };
  Range speed = {};                 // factor on the planned speed of each translation, 1e-3 to 1e3
  Range turn = {};                  // and of each rotation
  double stops_per_hour = 0.0;      // of motion, 0 to 36,000
  double mean_stop = 0.0;           // seconds, 0 to 1e6, exponential
  Range start_delay = {0.0, 0.0};   // seconds before each action, 0 to 1e6
  double cross_track_sigma = 0.0;   // metres beside translations, >= 0, normal
  double correlation_length = 1.0;  // metres between independent offsets, > 0
};

/// Margins of a plan, see Options.
struct Margins {
  double interval_margin = 0.0;   // seconds
  double inflation = 0.0;         // metres
  double wait_before_move = 0.0;  // seconds
};

/// What is asked: docs/margins.md, The request.
struct MarginsQuestion {
  ExecutionPolicy policy = ExecutionPolicy::dependencies;
  double max_delay = 0.0;  // seconds, >= 0, for the policy `clock_stop`
  Disturbance disturbance = {};
  double collisions = 0.01;   // 1e-4 to 0.5: the most bad runs, with a collision or a deadlock
  double confidence = 0.95;   // 0.5 to 0.9999
  std::size_t runs = 20'000;  // 50 to 100,000: the most of one plan
  std::uint64_t seed = 0;     // of the disturbances
  /// 1 to 64. Values that are less than those of the options are these; so candidates that are the same are
  /// tried once. The options themselves, the base, come first.
  std::vector<Margins> candidates = {{0.25}, {0.5}, {1.0}, {2.0}, {4.0}};
  std::vector<double> body_radii = {};         // metres, by robot: what collides; empty: the radii
  std::vector<double> execution_margins = {};  // metres, by robot, of dependencies; empty: 0
  double dependency_slack = 0.1;               // seconds, > 0
};

/// A place in the actions of a robot: its action is executed up to the fraction, in [0, 1].
struct ActionProgress {
  std::size_t robot = 0;
  std::size_t action = 0;
  double fraction = 0.0;
};

/// The robot of `gate` may not pass it until the robot of `until` has come there: docs/execution.md.
struct Dependency {
  ActionProgress gate;
  ActionProgress until;
  double slack = 0.0;  // seconds: the planned time of `gate` less that of `until`
};

/// What was found of one candidate.
struct TriedMargins {
  enum class Status { met, not_met, undecided, not_planned, not_run };
  Margins margins;
  Status status = Status::not_run;
  std::optional<Objectives> planned = {};  // none: not planned
  std::size_t runs = 0;
  std::size_t bad = 0;  // of them
  std::size_t collided = 0;
  std::size_t deadlocked = 0;
  std::optional<Objectives> executed = {};  // means over the runs in which all robots arrive
  std::optional<std::size_t> tight = {};    // pairs with too little slack for their dependencies
};

struct FoundMargins {
  std::vector<TriedMargins> tried = {};       // the base first
  std::optional<std::size_t> best = {};       // the cheapest one that is met
  std::optional<Plan> plan = {};              // of `best`, as it was executed
  std::vector<Dependency> dependencies = {};  // of this plan, with the policy `dependencies`
  bool deterministic = true;                  // false if the clock ended a plan or a test
};

/// Finds the cheapest margins with which the plan of a problem holds when it is executed: docs/margins.md,
/// Method. `options.time_budget` bounds it, of which planning has 0.4. The computation takes place in the
/// calling thread; `control.progress` is not called. `tried` is empty if the time did not suffice for the
/// base and its first 50 runs, or if a stop was requested before.
///
/// Throws InvalidProblem if faults_of() has any, std::invalid_argument if the question is out of its ranges,
/// and std::logic_error if the checker rejects a plan: a bug of the library.
FoundMargins find_margins(const Problem& problem, const MarginsQuestion& question,
                          const Options& options = {}, const Control& control = {});

}  // namespace fleetplan
