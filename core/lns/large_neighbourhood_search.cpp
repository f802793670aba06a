#include "core/lns/large_neighbourhood_search.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "core/lns/incumbent.h"
#include "core/lns/iterations.h"
#include "core/lns/pipeline.h"
#include "core/runtime/budget.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::core {
namespace {

/// The lag of the pipeline is this share of the robots, within bounds. It is long enough to keep several
/// threads busy while one step takes long. It is short enough that changes of overlapping steps seldom
/// conflict. For the makespan they often do, because the robot that arrives last is part of many.
constexpr std::size_t kRobotsPerLag = 10;
constexpr std::size_t kLeastLag = 4;
constexpr std::size_t kMaxLag = 16;
/// The most threads; each needs about as much memory as the plan itself.
constexpr std::size_t kMaxThreads = 4;
/// Steps of a round with a report before it, and without: at its end, threads wait for each other.
constexpr std::size_t kReportedRound = 32;
constexpr std::size_t kRound = 1024;
/// Steps with a search for each robot before vertices get more neighbours (WorkspacePool::add_moves). Twice
/// as many before they get more again. At first, the number of improvements matters; later, their quality.
constexpr std::size_t kStepsPerRobot = 8;
/// Iterations without an improvement after which it is tested whether one is possible.
constexpr int kVainIterations = 32;

/// An iteration, or a test whether a robot can become cheaper.
struct Step {
  std::optional<Exhaustion::Test> test;
  Iteration iteration;
};

bool is_for_makespan(const PlanState& state) {
  return state.instance().options().objective == PlanOptions::Objective::makespan;
}

std::size_t lag(const PlanState& state, std::size_t planned) {
  return is_for_makespan(state) ? kLeastLag : std::clamp(planned / kRobotsPerLag, kLeastLag, kMaxLag);
}

class LargeNeighbourhoodSearch {
 public:
  LargeNeighbourhoodSearch(PlanState& state, std::vector<std::size_t> planned, const TautPathBounds& bounds,
                           Random& random, Executor& executor, const StopCondition& stop)
      : incumbent_(state, std::move(planned)),
        exhaustion_(incumbent_, bounds, is_for_makespan(state)),
        iterations_(incumbent_, exhaustion_, bounds, random, stop, is_for_makespan(state)),
        steps_(lag(state, incumbent_.planned().size())),
        steps_with_moves_(kStepsPerRobot * incumbent_.planned().size()),
        steps_before_more_moves_(steps_with_moves_),
        workspaces_(state, incumbent_, stop),
        executor_(executor),
        stop_(stop),
        time_to_smooth_(after_share(stop, 1.0 - budget::kShareOfSmoothing)) {}

  LnsResult run(std::int64_t max_iterations, const BeforeRound& before_round) {
    iterations_left_ = max_iterations;
    iterations_to_smooth_ =
        static_cast<std::int64_t>(budget::kShareOfSmoothing * static_cast<double>(max_iterations));
    try {
      improve(before_round);
    } catch (const std::bad_alloc&) {  // not granted to the job
      result_.cut_off = true;
    }
    if (is_short_of_memory()) workspaces_.release_others();
    iterations_.return_to_best();
    workspaces_.update_callers_state({});
    result_.cut_off = result_.cut_off || time_began_smoothing_;
    return result_;
  }

 private:
  void improve(const BeforeRound& before_round) {
    do {
      run_rounds(before_round);
      complete_all();  // which may lead to something to try again
    } while (iterations_left_ > 0 && !result_.exhausted && !result_.cut_off);
  }

  void run_rounds(const BeforeRound& before_round) {
    result_.exhausted = is_exhausted();
    while (iterations_left_ > 0 && !result_.exhausted && !result_.cut_off) {
      if (before_round && !stop_.met()) {
        workspaces_.update_callers_state(iterations_.best().differences());
        before_round(result_);
      }
      if (!before_round) workspaces_.update_callers_state({});
      run_round(steps_of_round(before_round ? kReportedRound : kRound));
      result_.exhausted = is_exhausted();
      result_.cut_off = !result_.exhausted && (!may_improve_ || stop_.met() || !has_memory());
    }
  }

  /// Whether nothing is left to try, with more neighbours of vertices either.
  bool is_exhausted() {
    if (nothing_left() && exhaustion_.has_proofs()) add_moves();
    return nothing_left();
  }

  /// Whether nothing is left to try from the best plan, to which the search returns first if it has strayed.
  bool nothing_left() {
    if (!exhaustion_.nothing_left()) return false;
    return !iterations_.return_to_best() || exhaustion_.nothing_left();
  }

  /// The steps of the next round, at most so many. A round ends where vertices get more neighbours, so that
  /// this depends on the steps before alone.
  std::size_t steps_of_round(std::size_t max_steps) {
    if (steps_before_more_moves_ == 0) add_moves();
    return may_add_moves_ ? std::min(max_steps, steps_before_more_moves_) : max_steps;
  }

  void add_moves() {
    if (!may_add_moves_) return;
    steps_with_moves_ *= 2;
    steps_before_more_moves_ = steps_with_moves_;
    may_add_moves_ = may_help_ && workspaces_.add_moves();
    if (may_add_moves_) exhaustion_.forget();
    shortages_ = memory_shortages();
  }

  void run_round(std::size_t steps) {
    is_over_ = false;
    MemoryAccount* account = MemoryScope::current();
    const std::thread::id caller = std::this_thread::get_id();
    const auto task = [&](std::size_t) {
      const MemoryScope scope(account);
      if (!is_over_ && std::this_thread::get_id() == caller) ask_executor();
      if (!is_over_) run_step();
    };
    CallerThread callers_thread;
    (may_help_ ? executor_ : callers_thread).run_on(kMaxThreads, steps, task);
  }

  void ask_executor() {
    may_improve_ = executor_.may_improve(stop_);
    if (!may_improve_) is_over_ = true;
  }

  /// Runs one step, on any thread. Steps are begun and completed by one thread at a time.
  void run_step() {
    std::unique_ptr<Workspace> workspace = workspaces_.take();
    if (!workspace) {
      is_over_ = true;
      return;
    }
    try {
      const auto running = steps_.begin([&](Step& step) { complete(step, *workspace); },
                                        [&] { return next_step(*workspace); });
      if (running) run(*running, *workspace);
    } catch (const std::bad_alloc&) {  // not granted to the job
      workspace->invalidate();
    }
    workspaces_.give_back(std::move(workspace));
  }

  std::optional<Step> next_step(Workspace& workspace) {
    if (iterations_left_ == 0 || nothing_left() || stop_.met() || memory_shortages() != shortages_) {
      is_over_ = true;
    }
    if (is_over_) return std::nullopt;
    begin_smoothing_if_due();
    workspace.update();
    Step step;
    if (iterations_.vain() >= kVainIterations)
      step.test = exhaustion_.next_test(static_cast<std::int64_t>(effort_));
    if (!step.test) {
      --iterations_left_;
      step.iteration = iterations_.choose();
    }
    const bool searches = step.test || step.iteration.options.settings;
    if (searches && steps_before_more_moves_ > 0) --steps_before_more_moves_;
    return step;
  }

  void begin_smoothing_if_due() {
    if (has_begun_smoothing_ || !incumbent_.may_smooth()) return;
    time_began_smoothing_ = time_to_smooth_.is_over();
    has_begun_smoothing_ = time_began_smoothing_ || iterations_left_ <= iterations_to_smooth_;
    if (has_begun_smoothing_) iterations_.begin_smoothing();
  }

  void run(Step& step, Workspace& workspace) const {
    if (step.test) {
      exhaustion_.run(*step.test, workspace.state(), stop_);
    } else {
      iterations_.run(step.iteration, workspace);
    }
  }

  void complete(Step& step, Workspace& workspace) {
    if (step.test) return exhaustion_.learn(*step.test);
    if (iterations_.accept(step.iteration, workspace)) ++result_.improvements;
    result_.expansions += step.iteration.result.expansions;
    effort_ += step.iteration.result.effort;
  }

  void complete_all() {
    std::unique_ptr<Workspace> workspace = workspaces_.take();
    if (!workspace) {
      workspaces_.release_others();
      workspace = workspaces_.take();
    }
    try {
      steps_.complete_all([&](Step& step) { complete(step, *workspace); });
    } catch (const std::bad_alloc&) {  // not granted to the job
      workspace->invalidate();
    }
    workspaces_.give_back(std::move(workspace));
    result_.exhausted = nothing_left();
    result_.cut_off = result_.cut_off && !result_.exhausted;
  }

  /// Whether the last round had enough memory, or the next one may have: without the threads that help.
  bool has_memory() {
    const bool had_enough = memory_shortages() == shortages_;
    shortages_ = memory_shortages();
    if (had_enough) return true;
    may_help_ = false;
    return workspaces_.release_others();
  }

  Incumbent incumbent_;
  Exhaustion exhaustion_;
  Iterations iterations_;
  Pipeline<Step> steps_;
  std::size_t steps_with_moves_;  // with the neighbours that vertices have now
  std::size_t steps_before_more_moves_;
  bool may_add_moves_ = true;
  WorkspacePool workspaces_;
  Executor& executor_;
  const StopCondition& stop_;
  const StopCondition time_to_smooth_;
  bool has_begun_smoothing_ = false;
  bool time_began_smoothing_ = false;  // not the number of iterations
  std::int64_t iterations_left_ = 0;
  std::int64_t iterations_to_smooth_ = 0;
  LnsResult result_;
  double effort_ = 0.0;                // of the iterations, in expansions
  std::atomic<bool> is_over_ = false;  // the round is over
  bool may_improve_ = true;            // the last answer of the executor
  bool may_help_ = true;               // threads of the executor may help
  std::int64_t shortages_ = memory_shortages();
};

}  // namespace

LnsResult large_neighbourhood_search(PlanState& state, const std::vector<std::size_t>& movers,
                                     const TautPathBounds& bounds, Random& random, Executor& executor,
                                     const StopCondition& stop, const BeforeRound& before_round) {
  std::vector<std::size_t> planned;
  for (const std::size_t robot : movers) {
    if (state.reservations().trajectory(robot)) planned.push_back(robot);
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
