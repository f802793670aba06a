#pragma once

// The cheapest margins with which a plan holds when robots are disturbed: plans a fleet with several margins,
// executes each plan many times, and tells which of them meet an aim. A function of values.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/execution/simulation/disturbance.h"
#include "core/execution/simulation/execution_policy.h"
#include "core/execution/simulation/share_test.h"
#include "core/model/plan.h"
#include "core/plan/make_plan.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The options of a plan that keep robots apart when they are not where they are planned.
struct Margins {
  double interval_margin = 0.0;   // seconds, see PlanOptions
  double inflation = 0.0;         // metres
  double wait_before_move = 0.0;  // seconds

  bool operator==(const Margins&) const = default;
};

/// What is asked.
struct MarginTask {
  PlanTask plan;                    // with the options of the base
  std::vector<Margins> candidates;  // different from each other; the first one, the base, has those options
  std::vector<double> body_radii;   // metres, by robot: what collides
  ExecutionPolicy policy = ExecutionPolicy::dependencies;
  double max_delay = 0.0;  // seconds, for the policy `clock_stop`
  Disturbance disturbance;
  ShareAim aim;               // of runs with a collision or a deadlock
  std::size_t runs = 20'000;  // the most of one plan; at least ShareTest::kFirstLook
  std::uint64_t seed = 0;     // of the disturbances, which all plans meet
  /// For the policy `dependencies`; their margins, by robot, are at least the inflation of the candidate.
  DependencyRules dependencies;
};

struct MarginProgress {
  enum class Stage { plan, execute };

  std::size_t candidate = 0;
  std::size_t candidates = 0;
  Stage stage = Stage::plan;
  std::size_t runs = 0;  // of this candidate
  std::size_t bad = 0;
};

/// With how much time and memory margins are found, and who follows that.
struct MarginMeans {
  StopCondition planning;  // the end of all planning; each candidate has its share of what is left
  StopCondition stop;      // the end of the runs
  Executor& executor;      // its threads change nothing but the time
  std::size_t max_kept = static_cast<std::size_t>(1) << 30;  // bytes of plans that wait for their runs
  std::function<bool()> go_on = {};                          // see SharedTurn; empty: it is not shared
  std::function<void(const MarginProgress&)> progress = {};
};

/// What was found of one candidate.
struct TriedMargins {
  enum class Status { met, not_met, undecided, not_planned, not_run };
  struct Pair {
    std::size_t first = 0;  // index of a robot
    std::size_t second = 0;
    std::size_t runs = 0;  // in which they collide
  };
  static constexpr std::size_t kMaxPairs = 5;
  /// The runs of candidates that need not be decided.
  static constexpr std::size_t kRunsForTable = 200;

  Margins margins;
  Status status = Status::not_run;
  std::optional<Objectives> planned = {};  // none: not planned
  std::size_t runs = 0;
  std::size_t bad = 0;  // with a collision or a deadlock
  std::size_t collided = 0;
  std::size_t deadlocked = 0;
  std::optional<Objectives> executed = {};  // means over the runs in which all robots arrive
  std::optional<std::size_t> tight = {};    // tight pairs; none: without dependencies
  std::vector<TightPair> tight_pairs = {};  // the first kMaxPairs of them
  std::vector<Pair> pairs = {};             // the kMaxPairs that collide in most runs
  std::size_t with_walls = 0;               // runs whose first collision is with a wall
  bool at_rest = false;  // robots collide where they stand before or after all of their moves

  double share() const { return static_cast<double>(bad) / static_cast<double>(runs); }
};

/// The plan of the best candidate, as it was executed.
struct TestedPlan {
  MadePlan made;
  std::optional<Dependencies> dependencies;  // with the policy `dependencies`
};

struct FoundMargins {
  std::vector<TriedMargins> tried;  // by candidate
  std::optional<std::size_t> best;
  std::optional<TestedPlan> plan;  // of `best`
  std::optional<VerifyReport>
      rejected;                    // of a plan that the check rejects, a bug: then there is nothing else
  RobotList unplanned;             // robots that have no plan with the base, either
  std::size_t dropped = 0;         // plans that did not fit in max_kept beside cheaper ones
  bool cheaper_undecided = false;  // a candidate that is cheaper than `best` is undecided
  bool deterministic = true;       // false if the clock or the load influenced anything
  bool finished = true;            // false if the time ended a plan or a test

  /// Whether there is anything to compare with: the base has a plan and its first runs.
  bool has_base() const { return !tried.empty() && tried.front().runs >= ShareTest::kFirstLook; }
};

/// Finds the cheapest margins that meet the aim:
///
/// 1. Plans each candidate. One that leaves a robot unplanned that the base plans, or has no dependencies
///    where the policy needs them, is not planned.
/// 2. Orders the plans by the objective of the options, equal ones by their number.
/// 3. Executes them in this order until the test of each has a verdict (share_test.h). The first one that is
///    met is the best. The first runs of the base come before all others, as costs are told over it.
/// 4. Executes those that are left kRunsForTable times each.
///
/// Plans and runs depend on the task only, unless a stop condition ends them.
FoundMargins find_margins(const MarginTask& task, const MarginMeans& means);

}  // namespace fleetplan::core
