#include "core/lns/large_neighbourhood_search.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "core/lns/adaptive_parameters.h"
#include "core/lns/delayed_choice.h"
#include "core/lns/incumbent.h"
#include "core/lns/replan.h"
#include "core/lns/workspace_pool.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::core {
namespace {

/// A delay below this is rounding, seconds.
constexpr double kLeastDelay = 1e-9;
/// Enough to keep several threads busy, few enough that changes of one round seldom conflict.
constexpr std::int64_t kIterationsPerRound = 4;
/// The share of its delay that the first robot has to gain in most iterations: the higher, the sooner a
/// search fails. Small gains count too, so one iteration in kIterationsPerAnyGain accepts any gain.
constexpr double kMinGainShare = 0.15;
constexpr std::size_t kIterationsPerAnyGain = 4;

/// After so many rounds without an improvement it is tested whether one is possible.
constexpr int kVainRounds = 8;
/// The search that finds a cheaper path if one of the others can.
constexpr SearchLimits kProof{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};
/// The effort for these tests: expansions at first, and as a share of those of the search.
constexpr std::int64_t kFirstProofExpansions = 1'000;
constexpr std::int64_t kProofShare = 8;

struct Iteration {
  AdaptiveParameters::Choice parameters;
  std::size_t first = 0;  // the robot that is to become cheaper
  ReplanOptions options;
  std::uint64_t seed = 0;
  ReplanResult result;
};

class LargeNeighbourhoodSearch {
 public:
  LargeNeighbourhoodSearch(PlanState& state, std::vector<std::size_t> planned, const TautPathBounds& bounds,
                           Random& random, Executor& executor, const StopCondition& stop)
      : for_makespan_(state.instance().options().objective == PlanOptions::Objective::makespan),
        incumbent_(state, std::move(planned)),
        workspaces_(state, incumbent_, stop),
        bounds_(bounds),
        random_(random),
        executor_(executor),
        stop_(stop),
        first_robots_(state.instance().size()),
        cheapest_(state.instance().size(), 0) {}

  LnsResult run(std::int64_t max_iterations, const BeforeRound& before_round) {
    try {
      improve(max_iterations, before_round);
    } catch (const std::bad_alloc&) {  // not granted to the job
      result_.cut_off = true;
    }
    if (is_short_of_memory()) workspaces_.release_others();
    workspaces_.update_all();
    return result_;
  }

 private:
  void improve(std::int64_t max_iterations, const BeforeRound& before_round) {
    result_.exhausted = nothing_left();
    while (max_iterations > 0 && !result_.exhausted && !result_.cut_off) {
      const std::int64_t count = std::min(kIterationsPerRound, max_iterations);
      max_iterations -= count;
      if (before_round && !stop_.met()) {
        workspaces_.update_all();
        before_round(result_);
      }
      const bool may_improve = executor_.may_improve(stop_);
      if (may_improve && !stop_.met()) run_round(static_cast<std::size_t>(count));
      if (may_improve && !stop_.met() && vain_rounds_ >= kVainRounds) test_next_robot();
      result_.exhausted = nothing_left();
      result_.cut_off = !result_.exhausted && (!may_improve || stop_.met() || !has_memory());
    }
  }

  const std::vector<std::size_t>& planned() const { return incumbent_.planned(); }
  double delay(std::size_t robot) const { return std::max(0.0, incumbent_.cost(robot) - bounds_[robot]); }
  double makespan() const { return incumbent_.cost(incumbent_.last_to_arrive()); }

  bool nothing_left() const {
    return at_lower_bound() || std::all_of(planned().begin(), planned().end(), [&](std::size_t robot) {
             return delay(robot) <= kLeastDelay || is_cheapest(robot);
           });
  }

  /// Whether the robot's trajectory is known to be the cheapest that the search finds without other robots.
  bool is_cheapest(std::size_t robot) const { return cheapest_[robot] == incumbent_.version(robot) + 1; }

  /// Tests whether one of the delayed robots has a cheaper trajectory if no other robot moves.
  void test_next_robot() {
    const std::int64_t most = kFirstProofExpansions + result_.expansions / kProofShare - proof_expansions_;
    if (most <= 0) return;
    const std::size_t count = planned().size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t robot = planned()[next_to_test_++ % count];
      if (delay(robot) <= kLeastDelay || is_cheapest(robot)) continue;
      std::unique_ptr<Workspace> workspace = workspaces_.take();
      SearchLimits limits = kProof;
      limits.bound = incumbent_.cost(robot) - kLeastDelay;
      limits.max_expansions = most;
      const SearchResult result = workspace->state().plan_ignoring(planned(), robot, limits, stop_);
      workspaces_.give_back(std::move(workspace));
      proof_expansions_ += result.expansions;
      if (!result.trajectory && result.complete) cheapest_[robot] = incumbent_.version(robot) + 1;
      return;
    }
  }

  bool at_lower_bound() const {
    if (planned().empty()) return true;
    if (for_makespan_) {
      double bound = 0.0;
      for (const std::size_t robot : planned()) bound = std::max(bound, bounds_[robot]);
      return makespan() <= bound + kLeastDelay;
    }
    return std::all_of(planned().begin(), planned().end(),
                       [&](std::size_t robot) { return delay(robot) <= kLeastDelay; });
  }

  /// Whether the last round had enough memory, or the next one may have: without the threads that help.
  bool has_memory() {
    const bool had_enough = memory_shortages() == shortages_;
    shortages_ = memory_shortages();
    if (had_enough) return true;
    may_help_ = false;
    return workspaces_.release_others();
  }

  void run_tasks(std::size_t count, const Executor::Task& task) {
    MemoryAccount* account = MemoryScope::current();
    const auto counted = [&](std::size_t k) {
      const MemoryScope scope(account);
      task(k);
    };
    CallerThread callers_thread;
    (may_help_ ? executor_ : callers_thread).run(count, counted);
  }

  void run_round(std::size_t count) {
    std::vector<Iteration> iterations;
    iterations.reserve(count);
    for (std::size_t k = 0; k < count; ++k) iterations.push_back(next_iteration());
    run_tasks(count, [&](std::size_t k) { destroy_and_repair(iterations[k]); });
    std::vector<std::size_t> changed;
    ++vain_rounds_;
    for (Iteration& iteration : iterations) {
      learn(iteration);
      std::optional<Change>& change = iteration.result.change;
      if (!change || is_outdated(*change, changed)) continue;
      ++result_.improvements;
      vain_rounds_ = 0;
      for (Change::Part& part : change->parts) {
        changed.push_back(part.robot);
        incumbent_.replace(part.robot, std::move(part.trajectory));
      }
    }
  }

  Iteration next_iteration() {
    Iteration iteration;
    iteration.parameters = parameters_.choose(random_);
    iteration.options.min_gain_share = random_.below(kIterationsPerAnyGain) == 0 ? 0.0 : kMinGainShare;
    iteration.options.limits = iteration.parameters.search_limits();
    iteration.seed = random_.seed();
    if (for_makespan_) iteration.options.cost_limit = makespan();
    if (for_makespan_ && random_.below(2) == 0) {
      iteration.options.gain = ReplanOptions::Gain::first;
      iteration.first = incumbent_.last_to_arrive();
    } else {
      iteration.first = choose_delayed();
    }
    return iteration;
  }

  std::size_t choose_delayed() {
    std::vector<double> delays;
    delays.reserve(planned().size());
    for (const std::size_t robot : planned()) delays.push_back(delay(robot));
    return first_robots_.choose(planned(), delays, random_);
  }

  /// On any thread.
  void destroy_and_repair(Iteration& iteration) {
    std::unique_ptr<Workspace> workspace = workspaces_.take();
    if (!workspace) return;
    try {
      iteration.result = repaired(*workspace, iteration);
    } catch (const std::bad_alloc&) {  // not granted to the job
      workspace->invalidate();
    }
    workspaces_.give_back(std::move(workspace));
  }

  ReplanResult repaired(Workspace& workspace, const Iteration& iteration) {
    Random random(iteration.seed);
    const AdaptiveParameters::Choice& parameters = iteration.parameters;
    const auto robots = workspace.neighbourhoods().select(iteration.first, parameters.neighbourhood(),
                                                          parameters.robots(), random);
    return replan(workspace.state(), robots, bounds_, iteration.options, stop_);
  }

  void learn(const Iteration& iteration) {
    const ReplanResult& result = iteration.result;
    const double gain = result.change ? result.change->gain : 0.0;
    result_.expansions += result.expansions;
    parameters_.learn(iteration.parameters, gain, result.searches, result.expansions);
    first_robots_.learn(iteration.first, result.change.has_value());
  }

  /// Whether the change is no longer acceptable, as the trajectories of `changed` have been replaced since.
  bool is_outdated(const Change& change, const std::vector<std::size_t>& changed) {
    if (changed.empty()) return false;
    const double makespan = this->makespan();
    const auto is_part = [&](std::size_t robot) {
      return std::any_of(change.parts.begin(), change.parts.end(),
                         [&](const Change::Part& part) { return part.robot == robot; });
    };
    if (std::any_of(changed.begin(), changed.end(), is_part)) return true;
    std::unique_ptr<Workspace> workspace = workspaces_.take();
    if (!workspace) return true;
    bool outdated = false;
    for (const Change::Part& part : change.parts) {
      if (for_makespan_ && part.trajectory.cost > makespan) outdated = true;
      for (const std::size_t robot : workspace->state().conflicting_robots(part.robot, part.trajectory)) {
        outdated = outdated || !is_part(robot);
      }
    }
    workspaces_.give_back(std::move(workspace));
    return outdated;
  }

  const bool for_makespan_;
  Incumbent incumbent_;
  WorkspacePool workspaces_;
  const TautPathBounds& bounds_;
  Random& random_;
  Executor& executor_;
  const StopCondition& stop_;
  AdaptiveParameters parameters_;
  DelayedChoice first_robots_;
  int vain_rounds_ = 0;
  std::vector<std::int64_t> cheapest_;  // by robot: one more than the version known to be the cheapest; or 0
  std::size_t next_to_test_ = 0;        // of planned()
  std::int64_t proof_expansions_ = 0;
  LnsResult result_;
  bool may_help_ = true;  // threads of the executor
  std::int64_t shortages_ = memory_shortages();
};

}  // namespace

LnsResult large_neighbourhood_search(PlanState& state, const std::vector<std::size_t>& movers,
                                     const TautPathBounds& bounds, Random& random, Executor& executor,
                                     const StopCondition& stop, const BeforeRound& before_round) {
  std::vector<std::size_t> planned;
  for (const std::size_t robot : movers) {
    if (state.trajectory(robot)) planned.push_back(robot);
  }
  constexpr auto kUnlimited = std::numeric_limits<std::int64_t>::max();
  const auto search =
      std::make_shared<LargeNeighbourhoodSearch>(state, std::move(planned), bounds, random, executor, stop);
  const LnsResult result =
      search->run(state.instance().options().max_iterations.value_or(kUnlimited), before_round);
  keep_for_later(search);
  return result;
}

}  // namespace fleetplan::core
