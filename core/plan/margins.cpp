#include "core/plan/margins.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <variant>

#include "core/execution/simulation/simulation.h"
#include "core/model/objective_share.h"
#include "core/runtime/budget.h"
#include "core/runtime/memory_lack.h"
#include "core/runtime/shared_turn.h"

namespace fleetplan::core {
namespace {

using Status = TriedMargins::Status;

/// Adds up the runs of one candidate.
struct Tally {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> pairs;  // runs in which two robots collide
  std::size_t arrived = 0;                                           // runs in which all robots arrive
  Objectives sums;                                                   // over these

  void add(const Simulator::Run& run, TriedMargins& tried) {
    ++tried.runs;
    tried.bad += run.collisions.first || !run.stuck.empty() ? 1 : 0;
    tried.collided += run.collisions.first ? 1 : 0;
    tried.deadlocked += run.stuck.empty() ? 0 : 1;
    tried.with_walls += run.collisions.first && !run.collisions.first->second ? 1 : 0;
    for (const auto& pair : run.collisions.pairs) ++pairs[pair];
    if (!run.stuck.empty()) return;
    ++arrived;
    sums.flowtime += std::accumulate(run.ends.begin(), run.ends.end(), 0.0);
    sums.makespan += run.ends.empty() ? 0.0 : *std::max_element(run.ends.begin(), run.ends.end());
  }

  /// Writes what the runs say together.
  void tell(TriedMargins& tried) const {
    if (arrived > 0) {
      const auto count = static_cast<double>(arrived);
      tried.executed = Objectives{sums.flowtime / count, sums.makespan / count};
    }
    tried.pairs.clear();
    for (const auto& [pair, runs] : pairs) {  // by ascending robots
      const auto fewer = [](const TriedMargins::Pair& a, const TriedMargins::Pair& b) {
        return a.runs > b.runs;
      };
      const TriedMargins::Pair one{pair.first, pair.second, runs};
      tried.pairs.insert(std::upper_bound(tried.pairs.begin(), tried.pairs.end(), one, fewer), one);
      if (tried.pairs.size() > TriedMargins::kMaxPairs) tried.pairs.pop_back();
    }
  }
};

/// Where robots stand before they have moved, or after all of their moves.
std::vector<Position> places(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans,
                             bool at_end) {
  std::vector<Position> all;
  all.reserve(robots.size());
  for (const Robot& robot : robots) all.push_back(robot.start.position);
  if (!at_end) return all;
  for (const RobotPlan& plan : plans) {
    if (!plan.actions.empty()) all[plan.robot] = plan.actions.back().to.position;
  }
  return all;
}

std::size_t bytes_of(const MadePlan& made) {
  std::size_t actions = 0;
  for (const RobotPlan& plan : made.plan.plans) actions += plan.actions.size();
  for (const Robot& robot : made.task.problem.robots()) {
    actions += robot.committed.size() + (robot.previous ? robot.previous->size() : 0);
  }
  return actions * sizeof(Action) + made.plan.plans.size() * (sizeof(RobotPlan) + sizeof(Robot));
}

/// Returns the task with the margins of a candidate; none if robots do not fit with them, or if `stop` is
/// met.
std::optional<PlanTask> with_margins(const PlanTask& base, const Margins& margins,
                                     const StopCondition& stop) {
  PlanTask task = base;
  task.options.interval_margin = margins.interval_margin;
  task.options.inflation = margins.inflation;
  task.options.wait_before_move = margins.wait_before_move;
  if (margins.inflation == base.options.inflation) return task;
  ProblemConditions conditions = conditions_of(task.options);
  conditions.obstacles = base.problem.obstacles();
  conditions.zones = base.problem.zones();
  auto made = Problem::create(base.problem.map(), base.open ? base.open->robots : base.problem.robots(),
                              std::move(conditions), stop);
  auto* problem = std::get_if<Problem>(&made);
  if (problem == nullptr) return std::nullopt;
  task.problem = std::move(*problem);
  return task;
}

class MarginSearch {
 public:
  MarginSearch(const MarginTask& task, const MarginMeans& means)
      : task_(task),
        means_(means),
        turn_(means.stop, means.go_on),
        stop_(turn_.stop()),
        test_(task.aim, task.candidates.size(), task.runs),
        made_(task.candidates.size()),
        tallies_(task.candidates.size()) {
    for (const Margins& margins : task.candidates) found_.tried.push_back({.margins = margins});
  }

  FoundMargins run() {
    if (!plan_all() || !made_.front()) return std::move(found_);
    const std::vector<std::size_t> order = by_objective();
    execute(0, ShareTest::kFirstLook);
    if (!found_.has_base()) return std::move(found_);
    for (std::size_t place = 0; place < order.size() && !found_.best; ++place) {
      const std::size_t candidate = order[place];
      execute(candidate, task_.runs);
      if (found_.tried[candidate].status == Status::met) {
        found_.best = candidate;
      } else {
        found_.cheaper_undecided =
            found_.cheaper_undecided || found_.tried[candidate].status == Status::undecided;
        if (found_.tried[candidate].status == Status::not_met && candidate != 0) made_[candidate].reset();
      }
    }
    for (const std::size_t candidate : order) {
      if (!made_[candidate]) continue;
      execute(candidate, std::min(task_.runs, TriedMargins::kRunsForTable));
      if (candidate != found_.best) made_[candidate].reset();
    }
    if (found_.best) found_.plan = std::move(made_[*found_.best]);
    return std::move(found_);
  }

 private:
  /// Plans all candidates. Returns false if a plan is rejected, which is a bug.
  bool plan_all() {
    for (std::size_t candidate = 0; candidate < made_.size(); ++candidate) {
      tell(candidate, MarginProgress::Stage::plan);
      if (means_.planning.met() && candidate > 0) {
        found_.finished = found_.deterministic = false;
        break;
      }
      if (!plan(candidate)) return false;
      if (!made_.front()) break;  // nothing to compare with
      keep_within_memory();
    }
    return true;
  }

  /// Plans a candidate in its share of the time. Returns false if the plan is rejected.
  bool plan(std::size_t candidate) {
    const auto left = static_cast<double>(made_.size() - candidate);
    const StopCondition share = after_share(means_.planning, 1.0 / left);
    TriedMargins& tried = found_.tried[candidate];
    tried.status = Status::not_planned;
    auto task = with_margins(task_.plan, tried.margins, share);
    if (!task) {
      note_end(share);
      return true;
    }
    MadePlan made = make_plan(std::move(*task), plan_means(share));
    found_.deterministic = found_.deterministic && made.plan.deterministic;
    if (!made.report) {
      found_.deterministic = found_.finished = false;
      return true;
    }
    if (!made.report->valid()) {
      found_.rejected = std::move(made.report);
      return false;
    }
    if (candidate == 0) {
      unplanned_.assign(made.task.problem.robots().size(), false);
      for (const Unplanned& robot : made.plan.unplanned) unplanned_[robot.robot] = true;
      std::vector<std::size_t> robots;
      for (const Unplanned& robot : made.plan.unplanned) robots.push_back(robot.robot);
      found_.unplanned = RobotList(std::move(robots));
    }
    const bool leaves_any_more =
        std::any_of(made.plan.unplanned.begin(), made.plan.unplanned.end(),
                    [&](const Unplanned& robot) { return !unplanned_[robot.robot]; });
    if (leaves_any_more) {
      found_.finished = found_.finished && made.plan.deterministic;  // more time might plan them
      return true;
    }
    keep(candidate, std::move(made), share);
    return true;
  }

  /// Notes whether the time was over when something was not made.
  void note_end(const StopCondition& stop) {
    if (stop.met()) found_.finished = found_.deterministic = false;
  }

  PlanMeans plan_means(const StopCondition& share) const {
    using Clock = StopCondition::Clock;
    budget::Request measure{.robots = task_.plan.problem.robots().size(),
                            .has_obstacles = !task_.plan.problem.obstacles().empty()};
    StopCondition planning = share;
    if (share.deadline() != Clock::time_point::max()) {
      measure.budget = std::max(budget::Duration::zero(), budget::Duration(share.deadline() - Clock::now()));
      budget::Duration kept = budget::kept_for_answer(measure);
      if (needs_dependencies()) kept += budget::for_dependencies(measure);
      planning = share.until(share.deadline() - std::chrono::duration_cast<Clock::duration>(kept));
    }
    return {.stop = planning,
            .patience = budget::patience_of_service(measure),
            .executor = means_.executor,
            .go_on = means_.go_on};
  }

  bool needs_dependencies() const { return task_.policy == ExecutionPolicy::dependencies; }

  /// Keeps the plan of a candidate, unless its dependencies are missing.
  void keep(std::size_t candidate, MadePlan made, const StopCondition& share) {
    TriedMargins& tried = found_.tried[candidate];
    TestedPlan plan{std::move(made), std::nullopt};
    if (needs_dependencies()) {
      DependencyRules rules = task_.dependencies;
      for (double& margin : rules.margins) margin = std::max(margin, tried.margins.inflation);
      plan.dependencies =
          dependencies_in_memory(plan.made.task.problem.robots(), plan.made.plan.plans, rules, share);
      if (!plan.dependencies) {
        note_end(share);
        return;
      }
      const std::vector<TightPair>& tight = plan.dependencies->tight;
      tried.tight = tight.size();
      tried.tight_pairs.assign(tight.begin(), tight.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                  tight.size(), TriedMargins::kMaxPairs)));
    }
    tried.status = Status::not_run;
    tried.planned = plan.made.plan.objectives;
    made_[candidate] = std::move(plan);
  }

  /// Drops the costliest plans that do not fit beside the cheaper ones; never that of the base.
  void keep_within_memory() {
    std::size_t bytes = 0;
    for (const std::size_t candidate : by_objective()) {
      const std::size_t own = bytes_of(made_[candidate]->made);
      if (candidate == 0 || bytes + own <= means_.max_kept) {
        bytes += own;
        continue;
      }
      made_[candidate].reset();
      ++found_.dropped;
    }
  }

  /// The candidates that are planned, the cheapest one first.
  std::vector<std::size_t> by_objective() const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t candidate = 0; candidate < made_.size(); ++candidate) {
      if (!made_[candidate]) continue;
      const MadePlan& made = made_[candidate]->made;
      order.emplace_back(objective_value(made.plan, made.task.problem.robots(), task_.plan.options.objective),
                         candidate);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> candidates;
    candidates.reserve(order.size());
    for (const auto& [value, candidate] : order) candidates.push_back(candidate);
    return candidates;
  }

  /// Executes the plan of a candidate up to `runs` runs in all, or until its test has a verdict.
  void execute(std::size_t candidate, std::size_t runs) {
    TriedMargins& tried = found_.tried[candidate];
    const auto is_decided = [&] { return tried.status == Status::met || tried.status == Status::not_met; };
    if (is_decided() || tried.runs >= runs) return;
    const TestedPlan& plan = *made_[candidate];
    const Problem& problem = plan.made.task.problem;
    std::vector<RobotPlan> plans = plan.made.plan.plans;
    add_commitments(problem.robots(), plans);
    const SimulatedFleet fleet{
        problem.grid(), problem.robots(), task_.body_radii,
        planned_execution(problem.robots(), plans, task_.policy, task_.max_delay,
                          tried.margins.wait_before_move,
                          plan.dependencies ? plan.dependencies->list : std::vector<Dependency>())};
    const auto simulator = Simulator::make(fleet, {task_.disturbance, task_.runs, task_.seed}, stop_);
    Tally& tally = tallies_[candidate];
    // Bounded: looks, of which there are few; the runs ask the stop condition.
    while (simulator && !is_decided() && tried.runs < runs) {
      const std::size_t next = std::min(runs, test_.next_look(tried.runs));
      run_in_rounds(
          *simulator, tried.runs, next, stop_, means_.executor,
          [&](const Simulator::Run& run) { tally.add(run, tried); },
          [&] {
            tell(candidate, MarginProgress::Stage::execute);
            return turn_.share();
          });
      if (tried.runs < next) break;
      tried.status = status_of(test_.look(tried.bad, tried.runs));
    }
    if (tried.runs > 0 && !is_decided()) tried.status = Status::undecided;
    if (!is_decided() && tried.runs < runs) found_.finished = found_.deterministic = false;
    tally.tell(tried);
    tried.at_rest = any_at_rest(tally, problem.robots(), plans);
    if (candidate != 0) tally.pairs.clear();
  }

  static Status status_of(ShareTest::Verdict verdict) {
    if (verdict == ShareTest::Verdict::open) return Status::undecided;
    return verdict == ShareTest::Verdict::met ? Status::met : Status::not_met;
  }

  /// Whether robots that collide overlap where they stand, before or after all of their moves.
  bool any_at_rest(const Tally& tally, const std::vector<Robot>& robots,
                   const std::vector<RobotPlan>& plans) const {
    for (const bool at_end : {false, true}) {
      const std::vector<Position> at = places(robots, plans, at_end);
      // Bounded: the pairs that collide, of which the runs have found the last.
      for (const auto& [pair, runs] : tally.pairs) {
        const double least = task_.body_radii[pair.first] + task_.body_radii[pair.second] - kMaxTolerance;
        if ((at[pair.first] - at[pair.second]).squaredNorm() < least * least) return true;
      }
    }
    return false;
  }

  void tell(std::size_t candidate, MarginProgress::Stage stage) const {
    if (!means_.progress) return;
    const TriedMargins& tried = found_.tried[candidate];
    means_.progress({candidate, made_.size(), stage, tried.runs, tried.bad});
  }

  const MarginTask& task_;
  const MarginMeans& means_;
  SharedTurn turn_;
  const StopCondition stop_;  // shares the turn
  const ShareTest test_;
  std::vector<std::optional<TestedPlan>> made_;  // by candidate: the plans that are kept
  std::vector<Tally> tallies_;                   // by candidate
  std::vector<bool> unplanned_;                  // by robot: it has no plan with the base
  FoundMargins found_;
};

}  // namespace

FoundMargins find_margins(const MarginTask& task, const MarginMeans& means) {
  return MarginSearch(task, means).run();
}

}  // namespace fleetplan::core
