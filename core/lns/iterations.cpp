#include "core/lns/iterations.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

/// A delay below this is rounding, weighted seconds.
constexpr double kLeastDelay = 1e-9;
/// The limits of a search that finds a cheaper path if any of the searches can.
constexpr SearchLimits kProof{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};
/// The effort for tests whether a robot can become cheaper: expansions at first, and as a share of those of
/// the search.
constexpr std::int64_t kFirstProofExpansions = 1'000;
constexpr std::int64_t kProofShare = 8;

}  // namespace

double Exhaustion::delay(std::size_t robot) const {
  return std::max(0.0, incumbent_.share(robot) - incumbent_.least_share(robot, bounds_[robot]));
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
  if (!for_makespan_) return false;  // for the flowtime, no robot is delayed then
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
    test.limits.bound = incumbent_.cost_with_share(robot, incumbent_.share(robot) - kLeastDelay);
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

namespace {

/// The share of its delay that the first robot has to gain in most iterations: the higher, the sooner a
/// search fails. Small gains count too, so one iteration in kIterationsPerAnyGain accepts any gain.
constexpr double kMinGainShare = 0.15;
constexpr std::size_t kIterationsPerAnyGain = 4;
/// A change may make the flowtime longer by this share of the mean delay of the robots, which leads out of
/// local optima (threshold accepting; Dueck and Scheuer, 1990).
constexpr double kMostLossShare = 0.2;

}  // namespace

Iteration Iterations::choose() {
  Iteration iteration;
  iteration.version = incumbent_.version();
  iteration.parameters = parameters_.choose(random_);
  iteration.options.min_gain_share = random_.below(kIterationsPerAnyGain) == 0 ? 0.0 : kMinGainShare;
  iteration.options.limits = iteration.parameters.search_limits();
  iteration.seed = random_.seed();
  if (for_makespan_) iteration.options.cost_limit = incumbent_.makespan();
  if (for_makespan_ && random_.below(2) == 0) {
    iteration.options.gain = NeighbourhoodOptions::Gain::first;
    iteration.first = incumbent_.last_to_arrive();
  } else {
    iteration.first = choose_delayed();
  }
  if (!for_makespan_) iteration.options.most_loss = most_loss();
  return iteration;
}

double Iterations::most_loss() const {
  const auto count = static_cast<double>(incumbent_.planned().size());
  double delays = 0.0;
  for (const std::size_t robot : incumbent_.planned()) delays += exhaustion_.delay(robot);
  return kMostLossShare * delays / count;
}

std::size_t Iterations::choose_delayed() {
  std::vector<double> delays;
  delays.reserve(incumbent_.planned().size());
  for (const std::size_t robot : incumbent_.planned()) delays.push_back(exhaustion_.delay(robot));
  return first_robots_.choose(incumbent_.planned(), delays, random_);
}

void Iterations::run(Iteration& iteration, Workspace& workspace) const {
  Random random(iteration.seed);
  const AdaptiveParameters::Choice& parameters = iteration.parameters;
  const auto robots = workspace.neighbourhoods().select(iteration.first, parameters.neighbourhood(),
                                                        parameters.robots(), random);
  iteration.result = plan_neighbourhood(workspace.state(), robots, bounds_, iteration.options, stop_);
}

bool Iterations::accept(Iteration& iteration, Workspace& workspace) {
  std::optional<Change>& change = iteration.result.change;
  const bool accepted = change && !is_outdated(iteration, workspace);
  learn(iteration);
  if (!accepted) return false;
  for (Change::Part& part : change->parts) best_.replace(part.robot, std::move(part.trajectory));
  return best_.changed(change->gain);
}

void Iterations::learn(const Iteration& iteration) {
  const NeighbourhoodResult& result = iteration.result;
  const double gain = result.change ? std::max(0.0, result.change->gain) : 0.0;
  parameters_.learn(iteration.parameters, gain, result.searches, result.expansions);
  first_robots_.learn(iteration.first, result.change.has_value());
}

/// Whether the change is no longer acceptable, as other trajectories have been replaced since.
bool Iterations::is_outdated(const Iteration& iteration, Workspace& workspace) const {
  if (incumbent_.version() == iteration.version) return false;
  const std::vector<Change::Part>& parts = iteration.result.change->parts;
  const auto is_replaced = [&](const Change::Part& part) {
    return incumbent_.version(part.robot) > iteration.version;
  };
  if (std::any_of(parts.begin(), parts.end(), is_replaced)) return true;
  const auto is_part = [&](std::size_t robot) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const Change::Part& part) { return part.robot == robot; });
  };
  const double makespan = incumbent_.makespan();
  workspace.update();
  return std::any_of(parts.begin(), parts.end(), [&](const Change::Part& part) {
    if (for_makespan_ && part.trajectory.cost > makespan) return true;
    const auto conflicting = workspace.state().conflicting_robots(part.robot, part.trajectory);
    return !std::all_of(conflicting.begin(), conflicting.end(), is_part);
  });
}

}  // namespace fleetplan::core
