#include "core/lns/large_neighbourhood_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "core/lns/adaptive_choice.h"
#include "core/lns/delayed_choice.h"
#include "core/lns/neighbourhood.h"
#include "core/lns/replicas.h"
#include "core/lns/reroute.h"

namespace fleetplan::core {
namespace {

/// A delay below this is rounding, seconds.
constexpr double kLeastDelay = 1e-9;
/// Iterations in a round: enough to keep several threads busy, few enough that what they find seldom clashes.
constexpr std::int64_t kRound = 4;
constexpr std::array<std::size_t, 5> kSizes{1, 2, 4, 8, 16};
/// How hard to search. Greedy searches with few expansions find most of what can be found, and fail soon;
/// the others are for what is left.
constexpr std::array<SearchLimits, 3> kEfforts{{
    {.heuristic_weight = 1.5, .thorough = false, .max_expansions = 400},
    {.heuristic_weight = 1.5, .thorough = false, .max_expansions = 8'000},
    {.heuristic_weight = 1.0,
     .suboptimality = 0.0,
     .suboptimality_growth = 0.0,
     .dominance_slack = 0.0,
     .thorough = false,
     .max_expansions = 40'000},
}};
/// What share of its delay the first robot has to lose in most tries: the more is asked, the sooner a search
/// fails. But small gains are gains, too, so one try in so many asks for nothing.
constexpr double kAmbition = 0.15;
constexpr std::size_t kModestTries = 4;
/// What a search costs before its first expansion, in expansions.
constexpr double kSearchEffort = 20.0;

/// One try, and what came of it.
struct Iteration {
  std::size_t kind;
  std::size_t size;
  std::size_t effort;
  std::size_t first;  // the robot to become cheaper
  Aim aim;
  std::uint64_t seed;
  Rerouting rerouting;
};

class Improving {
 public:
  Improving(PlanState& state, std::vector<std::size_t> planned, const TautBounds& bounds, Random& random,
            Executor& executor, const StopCondition& stop)
      : for_makespan_(state.instance().options().objective == PlanOptions::Objective::makespan),
        incumbent_(state, std::move(planned)),
        replicas_(state, incumbent_, stop),
        bounds_(bounds),
        random_(random),
        executor_(executor),
        stop_(stop),
        firsts_(state.instance().size()) {}

  LnsResult run(std::int64_t max_iterations, const BeforeRound& before_round) {
    while (max_iterations > 0 && !at_lower_bound() && !result_.cut_off) {
      const std::int64_t count = std::min(kRound, max_iterations);
      max_iterations -= count;
      if (before_round && !stop_.met()) {
        replicas_.catch_up();
        before_round(result_);
      }
      if (!stop_.met()) round(static_cast<std::size_t>(count));
      result_.cut_off = stop_.met();
    }
    replicas_.catch_up();
    return result_;
  }

 private:
  const std::vector<std::size_t>& planned() const { return incumbent_.planned(); }
  double cost(std::size_t robot) const { return incumbent_.cost(robot); }
  double delay(std::size_t robot) const { return std::max(0.0, cost(robot) - bounds_[robot]); }

  bool at_lower_bound() const {
    if (planned().empty()) return true;
    if (for_makespan_) {
      double bound = 0.0;
      for (const std::size_t robot : planned()) bound = std::max(bound, bounds_[robot]);
      return cost(last_to_arrive()) <= bound + kLeastDelay;
    }
    return std::all_of(planned().begin(), planned().end(),
                       [&](std::size_t robot) { return delay(robot) <= kLeastDelay; });
  }

  std::size_t last_to_arrive() const {
    return *std::max_element(planned().begin(), planned().end(),
                             [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  }

  std::size_t choose_delayed() {
    std::vector<double> delays;
    delays.reserve(planned().size());
    for (const std::size_t robot : planned()) delays.push_back(delay(robot));
    return firsts_.choose(planned(), delays, random_);
  }

  void round(std::size_t count) {
    std::vector<Iteration> iterations;
    iterations.reserve(count);
    for (std::size_t k = 0; k < count; ++k) iterations.push_back(choose());
    executor_.run(count, [&](std::size_t k) { search(iterations[k]); });
    std::vector<std::size_t> changed;
    for (Iteration& iteration : iterations) {
      learn(iteration);
      if (!iteration.rerouting.change || clashes(*iteration.rerouting.change, changed)) continue;
      ++result_.improvements;
      for (Change::Part& part : iteration.rerouting.change->parts) {
        changed.push_back(part.robot);
        incumbent_.replace(part.robot, std::move(part.trajectory));
      }
    }
  }

  Iteration choose() {
    Iteration iteration{};
    iteration.kind = kinds_.choose(random_);
    iteration.size = sizes_.choose(random_);
    iteration.effort = efforts_.choose(random_);
    iteration.aim.ambition = random_.below(kModestTries) == 0 ? 0.0 : kAmbition;
    iteration.aim.limits = kEfforts[iteration.effort];
    iteration.seed = random_.seed();
    if (for_makespan_) iteration.aim.ceiling = cost(last_to_arrive());
    if (for_makespan_ && random_.below(2) == 0) {
      iteration.aim.gain = Aim::Gain::first;
      iteration.first = last_to_arrive();
    } else {
      iteration.first = choose_delayed();
    }
    return iteration;
  }

  /// On any thread.
  void search(Iteration& iteration) {
    std::unique_ptr<Replica> replica = replicas_.take();
    Random random(iteration.seed);
    const auto robots = replica->neighbourhoods().around(
        iteration.first, static_cast<Neighbourhood>(iteration.kind), kSizes[iteration.size], random);
    iteration.rerouting = reroute(replica->state(), robots, bounds_, iteration.aim, stop_);
    replicas_.give_back(std::move(replica));
  }

  void learn(const Iteration& iteration) {
    const Rerouting& rerouting = iteration.rerouting;
    const double gain = rerouting.change ? rerouting.change->gain : 0.0;
    const double effort =
        static_cast<double>(rerouting.expansions) + kSearchEffort * static_cast<double>(rerouting.searches);
    result_.expansions += rerouting.expansions;
    kinds_.learn(iteration.kind, gain, effort);
    sizes_.learn(iteration.size, gain, effort);
    efforts_.learn(iteration.effort, gain, effort);
    firsts_.learn(iteration.first, rerouting.change.has_value());
  }

  /// May the change no longer be made, as these robots have changed since?
  bool clashes(const Change& change, const std::vector<std::size_t>& changed) {
    if (changed.empty()) return false;
    const double makespan = cost(last_to_arrive());
    const auto is_part = [&](std::size_t robot) {
      return std::any_of(change.parts.begin(), change.parts.end(),
                         [&](const Change::Part& part) { return part.robot == robot; });
    };
    if (std::any_of(changed.begin(), changed.end(), is_part)) return true;
    std::unique_ptr<Replica> replica = replicas_.take();
    bool clash = false;
    for (const Change::Part& part : change.parts) {
      if (for_makespan_ && part.trajectory.cost > makespan) clash = true;
      for (const std::size_t hit : replica->state().conflicting_robots(part.robot, part.trajectory)) {
        clash = clash || !is_part(hit);
      }
    }
    replicas_.give_back(std::move(replica));
    return clash;
  }

  const bool for_makespan_;
  Incumbent incumbent_;
  Replicas replicas_;
  const TautBounds& bounds_;
  Random& random_;
  Executor& executor_;
  const StopCondition& stop_;
  AdaptiveChoice kinds_{kNeighbourhoods};
  AdaptiveChoice sizes_{kSizes.size()};
  AdaptiveChoice efforts_{kEfforts.size()};
  DelayedChoice firsts_;
  LnsResult result_;
};

}  // namespace

LnsResult large_neighbourhood_search(PlanState& state, const std::vector<std::size_t>& movers,
                                     const TautBounds& bounds, Random& random, Executor& executor,
                                     const StopCondition& stop, const BeforeRound& before_round) {
  std::vector<std::size_t> planned;
  for (const std::size_t robot : movers) {
    if (state.trajectory(robot)) planned.push_back(robot);
  }
  constexpr auto kEndless = std::numeric_limits<std::int64_t>::max();
  return Improving(state, std::move(planned), bounds, random, executor, stop)
      .run(state.instance().options().max_iterations.value_or(kEndless), before_round);
}

}  // namespace fleetplan::core
