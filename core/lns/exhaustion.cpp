#include "core/lns/exhaustion.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

/// A delay below this is rounding, seconds.
constexpr double kLeastDelay = 1e-9;
/// The search that finds a cheaper path if one of the others can.
constexpr SearchLimits kProof{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};
/// The effort for these tests: expansions at first, and as a share of those of the search.
constexpr std::int64_t kFirstProofExpansions = 1'000;
constexpr std::int64_t kProofShare = 8;

}  // namespace

double Exhaustion::delay(std::size_t robot) const {
  return std::max(0.0, incumbent_.cost(robot) - bounds_[robot]);
}

bool Exhaustion::may_gain(std::size_t robot) const {
  return delay(robot) > kLeastDelay && !is_cheapest(robot);
}

bool Exhaustion::nothing_left() const {
  const std::vector<std::size_t>& planned = incumbent_.planned();
  return at_lower_bound() ||
         std::none_of(planned.begin(), planned.end(), [&](std::size_t robot) { return may_gain(robot); });
}

bool Exhaustion::at_lower_bound() const {
  const std::vector<std::size_t>& planned = incumbent_.planned();
  if (planned.empty()) return true;
  if (!for_makespan_) return false;  // then no robot is delayed
  double bound = 0.0;
  for (const std::size_t robot : planned) bound = std::max(bound, bounds_[robot]);
  return incumbent_.makespan() <= bound + kLeastDelay;
}

std::optional<Exhaustion::Test> Exhaustion::next_test(std::int64_t expansions) {
  const std::int64_t most = kFirstProofExpansions + expansions / kProofShare - expansions_;
  if (is_testing_ || most <= 0) return std::nullopt;
  const std::vector<std::size_t>& planned = incumbent_.planned();
  for (std::size_t k = 0; k < planned.size(); ++k) {
    const std::size_t robot = planned[next_to_test_++ % planned.size()];
    if (!may_gain(robot)) continue;
    is_testing_ = true;
    Test test{robot, incumbent_.version(robot), kProof};
    test.limits.bound = incumbent_.cost(robot) - kLeastDelay;
    test.limits.max_expansions = most;
    return test;
  }
  return std::nullopt;
}

void Exhaustion::run(Test& test, PlanState& state, const StopCondition& stop) const {
  test.result = state.plan_ignoring(incumbent_.planned(), test.robot, test.limits, stop);
}

void Exhaustion::learn(const Test& test) {
  is_testing_ = false;
  expansions_ += test.result.expansions;
  if (!test.result.trajectory && test.result.complete) cheapest_[test.robot] = test.version;
}

}  // namespace fleetplan::core
