#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/lns/incumbent.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What the search has left to gain: the delays of the robots, and which of them are known to have no cheaper
/// trajectory.
class Exhaustion {
 public:
  /// A search for a cheaper trajectory of a delayed robot, as if no other planned robot were there.
  struct Test {
    std::size_t robot = 0;
    std::int64_t version = 0;  // of its trajectory
    SearchLimits limits;
    SearchResult result{std::nullopt, false, 0};
  };

  /// `for_makespan`: the objective. The arguments outlive this object.
  Exhaustion(const Incumbent& incumbent, const TautPathBounds& bounds, bool for_makespan)
      : incumbent_(incumbent),
        bounds_(bounds),
        for_makespan_(for_makespan),
        cheapest_(incumbent.robot_count()) {}

  /// Cost minus lower bound, seconds, >= 0.
  double delay(std::size_t robot) const;
  /// Whether the objective is equal to its lower bound, or no delayed robot can become cheaper.
  bool nothing_left() const;

  /// The next robot's test; none if no robot needs one, while one runs, or if the tests have had their share
  /// of the effort. `expansions`: of the search so far.
  std::optional<Test> next_test(std::int64_t expansions);
  void run(Test& test, PlanState& state, const StopCondition& stop) const;
  void learn(const Test& test);

 private:
  bool at_lower_bound() const;
  bool is_cheapest(std::size_t robot) const { return cheapest_[robot] == incumbent_.version(robot); }
  bool may_gain(std::size_t robot) const;

  const Incumbent& incumbent_;
  const TautPathBounds& bounds_;
  const bool for_makespan_;
  std::vector<std::optional<std::int64_t>> cheapest_;  // by robot: the version known to be the cheapest
  std::size_t next_to_test_ = 0;                       // of planned()
  bool is_testing_ = false;
  std::int64_t expansions_ = 0;  // of the tests
};

}  // namespace fleetplan::core
