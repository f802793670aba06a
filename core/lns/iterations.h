#pragma once

// The iterations of large neighbourhood search: how they choose by recent success, their results, and what
// the search has left to gain.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/fleet/plan_state.h"
#include "core/lns/incumbent.h"
#include "core/lns/neighbourhood.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/aa_sipp.h"

namespace fleetplan::core {

/// Chooses among a few alternatives by their recent gain per effort (adaptive large neighbourhood search;
/// Ropke and Pisinger, 2006). Every alternative keeps a positive probability.
class AdaptiveChoice {
 public:
  /// Chooses among `count` >= 1 alternatives, all equal at first.
  explicit AdaptiveChoice(std::size_t count) : records_(count) {}

  std::size_t choose(Random& random) const { return choose(random, records_.size()); }
  /// Chooses among the first `count` >= 1 of the alternatives.
  std::size_t choose(Random& random, std::size_t count) const;

  /// Records one try of the alternative: its gain (>= 0) and its effort (> 0), in any units.
  void learn(std::size_t alternative, double gain, double effort);

 private:
  struct Record {  // moving averages over tries
    double gain = 0.0;
    double effort = 0.0;  // 0: not tried yet
  };

  /// The gain per effort of an alternative.
  double rate(const Record& record) const;
  std::vector<double> weights(std::size_t count) const;

  std::vector<Record> records_;
};

/// Chooses the robot whose cost an iteration tries to reduce. The probability grows with the robot's delay
/// (cost minus lower bound) and falls with its recent failures.
class DelayedChoice {
 public:
  /// Chooses among robots 0 to count - 1.
  explicit DelayedChoice(std::size_t count) : failures_(count, 0.0) {}

  /// Returns one of `robots` (not empty); delays[k] >= 0 is the delay of robots[k] in seconds.
  std::size_t choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                     Random& random) const;

  /// Records whether an iteration made the robot cheaper.
  void learn(std::size_t robot, bool gained);
  /// Forgets the failures of a robot: it has a new trajectory.
  void forget(std::size_t robot) { failures_[robot] = 0.0; }

 private:
  std::vector<double> failures_;  // by robot; failures before a gain count less
};

/// The parameters of one iteration of large neighbourhood search: which robots, how many, and the effort.
/// Each is chosen by its recent gain per effort (see AdaptiveChoice).
class AdaptiveParameters {
 public:
  /// The choice of each parameter, as positions in the lists of possible values.
  struct Choice {
    std::size_t kind = 0;
    std::size_t size = 0;
    std::size_t settings = 0;

    /// One robot is smoothed only.
    static Choice smoothing();

    Neighbourhood neighbourhood() const { return static_cast<Neighbourhood>(kind); }
    std::size_t robots() const;
    /// The settings of searches. None if the iteration only smooths one robot.
    std::optional<SearchSettings> search_settings() const;
  };

  AdaptiveParameters();

  /// `may_smooth`: whether a robot may be smoothed only.
  Choice choose(Random& random, bool may_smooth) const;
  /// Records the result of an iteration: `gain` in seconds, >= 0, and its effort, > 0.
  void learn(const Choice& choice, double gain, double effort);

 private:
  AdaptiveChoice kinds_;
  AdaptiveChoice sizes_;
  AdaptiveChoice limits_;
};

/// What the search has left to gain: the delays of the robots, and which robots are known to have no cheaper
/// trajectory.
class Exhaustion {
 public:
  /// A search for a cheaper trajectory of a delayed robot, as if no other planned robot were there. The
  /// trajectory found is smoothed, and so is the robot's own.
  struct Test {
    std::size_t robot = 0;
    std::int64_t version = 0;  // version of the robot's trajectory
    int moves = 0;             // how often robots have got more moves
    double bound = kForever;   // seconds; a trajectory that costs as much is no cheaper
    SearchSettings settings;
    std::uint64_t seed = 0;  // of the smoothing
    SearchResult result{std::nullopt, false, 0};
  };

  /// `for_makespan`: whether the objective is the makespan. The arguments must outlive this object.
  Exhaustion(const Incumbent& incumbent, const TautPathBounds& bounds, bool for_makespan)
      : incumbent_(incumbent),
        bounds_(bounds),
        for_makespan_(for_makespan),
        cheapest_(incumbent.robot_count()) {}

  /// The delay of a robot, weighted seconds: its share in the objective minus a lower bound of the share, >=
  /// 0.
  double delay(std::size_t robot) const;
  /// Whether the objective is equal to its lower bound, or no delayed robot can become cheaper.
  bool nothing_left() const;

  /// Returns the next test. None if no robot needs a test, while one runs, or if the tests have had their
  /// share of the effort. `effort`: the effort of the search so far, in expansions.
  std::optional<Test> next_test(std::int64_t effort);
  void run(Test& test, PlanState& state, const StopCondition& stop) const;
  void learn(const Test& test);
  /// Whether a robot is known to have no cheaper trajectory.
  bool has_proofs() const;
  /// Forgets the proofs, because robots have more moves from now on.
  void forget();

 private:
  bool at_lower_bound() const;
  bool is_cheapest(std::size_t robot) const { return cheapest_[robot] == incumbent_.version(robot); }
  bool may_gain(std::size_t robot) const;

  const Incumbent& incumbent_;
  const TautPathBounds& bounds_;
  const bool for_makespan_;
  std::vector<std::optional<std::int64_t>> cheapest_;  // by robot: the version known to be the cheapest
  std::size_t next_to_test_ = 0;                       // position in planned()
  bool is_testing_ = false;
  int moves_ = 0;                // how often robots have got more moves
  std::int64_t expansions_ = 0;  // expansions of the tests, and paths that they timed
  std::uint64_t tests_ = 0;
};

/// An iteration of large neighbourhood search: what it tries, and the result.
struct Iteration {
  std::int64_t version = 0;  // version of the incumbent that it begins with
  AdaptiveParameters::Choice parameters;
  std::size_t first = 0;  // the robot that is to become cheaper
  NeighbourhoodOptions options;
  std::uint64_t seed = 0;
  NeighbourhoodResult result;
};

/// The turns of robots that are smoothed one after the other, again and again, until no robot gains.
class SmoothingTurns {
 public:
  void begin(std::vector<std::size_t> robots);
  bool are_over() const { return robots_.empty(); }
  /// The next robot that satisfies `may_gain`. If there is none, returns none, and the turns are over.
  std::optional<std::size_t> next(const std::function<bool(std::size_t)>& may_gain);
  /// Records whether a robot has gained in its turn.
  void learn(bool gained);

 private:
  std::vector<std::size_t> robots_;  // empty once they are over
  std::size_t position_ = 0;         // in robots_, from its begin again at its end
  std::size_t in_vain_ = 0;          // turns since one gained
};

/// The steps of an iteration: choose, run, accept. While an iteration runs, others may be chosen and
/// accepted.
class Iterations {
 public:
  /// `for_makespan`: whether the objective is the makespan. The arguments must outlive this object.
  Iterations(Incumbent& incumbent, const Exhaustion& exhaustion, const TautPathBounds& bounds, Random& random,
             const StopCondition& stop, bool for_makespan)
      : incumbent_(incumbent),
        exhaustion_(exhaustion),
        bounds_(bounds),
        random_(random),
        stop_(stop),
        for_makespan_(for_makespan),
        best_(incumbent),
        first_robots_(incumbent.robot_count()),
        smoothed_robots_(incumbent.robot_count()) {}

  /// Chooses what to try next, by recent success.
  Iteration choose();
  /// Goes back to the best plan. From then on, iterations smooth one robot after the other, the most delayed
  /// robot first, until no robot gains.
  void begin_smoothing();
  /// Plans the neighbourhood again, in a workspace with the incumbent at the time of choose(). May run on any
  /// thread.
  void run(Iteration& iteration, Workspace& workspace) const;
  /// Learns from the result and applies its change to the incumbent, unless it conflicts with changes made
  /// since choose(). Returns whether the incumbent is better than any plan before. After many iterations
  /// without a better plan, the incumbent becomes the best plan again. The workspace may be updated.
  bool accept(Iteration& iteration, Workspace& workspace);
  /// Makes the best plan the incumbent. Returns false if it is already.
  bool return_to_best();
  /// The number of iterations with a search since the last new best plan.
  std::int64_t vain() const { return vain_; }

  BestPlan& best() { return best_; }

 private:
  double max_loss() const;
  std::size_t choose_delayed(const DelayedChoice& choice);
  void learn(const Iteration& iteration);
  bool adopt(Iteration& iteration, Workspace& workspace);
  void stray();
  bool is_outdated(const Iteration& iteration, Workspace& workspace) const;

  Incumbent& incumbent_;
  const Exhaustion& exhaustion_;
  const TautPathBounds& bounds_;
  Random& random_;
  const StopCondition& stop_;
  const bool for_makespan_;
  BestPlan best_;
  AdaptiveParameters parameters_;
  DelayedChoice first_robots_;
  DelayedChoice smoothed_robots_;
  std::int64_t vain_ = 0;
  std::int64_t searches_ = 0;  // iterations with a search
  bool is_late_ = false;       // much is smoothed from now on
  std::int64_t straying_ = 0;  // iterations with more and more loss
  SmoothingTurns turns_;
};

}  // namespace fleetplan::core
