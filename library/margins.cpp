#include "core/plan/margins.h"

#include <fleetplan/limits.h>
#include <fleetplan/margins.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/execution/simulation/share_test.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "library/convert.h"

namespace fleetplan {

namespace {

static_assert(static_cast<int>(ExecutionPolicy::clock_stop) ==
              static_cast<int>(core::ExecutionPolicy::clock_stop));
static_assert(static_cast<int>(TriedMargins::Status::not_run) ==
              static_cast<int>(core::TriedMargins::Status::not_run));

constexpr std::size_t kMostRuns = 100'000;
constexpr std::size_t kMostCandidates = 64;

void require_within(double number, double least, double most, const char* what) {
  if (!(number >= least && number <= most)) {
    throw std::invalid_argument(std::string(what) + " is out of its range");
  }
}

void require_range(const Disturbance::Range& range, double least, double most, const char* what) {
  require_within(range.min, least, most, what);
  require_within(range.max, range.min, most, what);
}

void check(const Disturbance& disturbance) {
  constexpr double kLeastFactor = 1e-3;
  constexpr double kMostFactor = 1e3;
  constexpr double kMostDelay = 1e6;
  constexpr double kMostStops = 36'000.0;
  require_range(disturbance.speed, kLeastFactor, kMostFactor, "disturbance.speed");
  require_range(disturbance.turn, kLeastFactor, kMostFactor, "disturbance.turn");
  require_within(disturbance.stops_per_hour, 0.0, kMostStops, "disturbance.stops_per_hour");
  require_within(disturbance.mean_stop, 0.0, kMostDelay, "disturbance.mean_stop");
  require_range(disturbance.start_delay, 0.0, kMostDelay, "disturbance.start_delay");
  require_within(disturbance.cross_track_sigma, 0.0, kLargestExtent, "disturbance.cross_track_sigma");
  require_within(disturbance.correlation_length, kShortestLength, kLargestExtent,
                 "disturbance.correlation_length");
}

void check(const MarginsQuestion& question, std::size_t robots) {
  constexpr double kLeastAim = 1e-4;
  constexpr double kMostConfidence = 0.9999;
  check(question.disturbance);
  require_within(question.max_delay, 0.0, kLongestTime, "max_delay");
  require_within(question.collisions, kLeastAim, 0.5, "collisions");
  require_within(question.confidence, 0.5, kMostConfidence, "confidence");
  require_within(static_cast<double>(question.runs), core::ShareTest::kFirstLook, kMostRuns, "runs");
  require_within(static_cast<double>(question.candidates.size()), 1.0, kMostCandidates,
                 "the number of candidates");
  require_within(question.dependency_slack, 1e-3, kLongestTime, "dependency_slack");
  for (const Margins& margins : question.candidates) {
    require_within(margins.interval_margin, 0.0, kLongestTime, "interval_margin of a candidate");
    require_within(margins.inflation, 0.0, kLargestExtent, "inflation of a candidate");
    require_within(margins.wait_before_move, 0.0, kLongestTime, "wait_before_move of a candidate");
  }
  for (const auto* list : {&question.body_radii, &question.execution_margins}) {
    if (!list->empty() && list->size() != robots) {
      throw std::invalid_argument("a list by robot has another size than the robots");
    }
    for (const double length : *list) require_within(length, 0.0, kLargestExtent, "a length of a robot");
  }
}

core::Disturbance disturbance_of(const Disturbance& disturbance) {
  const auto range = [](const Disturbance::Range& one) { return core::UniformRange{one.min, one.max}; };
  return {.speed = range(disturbance.speed),
          .turn = range(disturbance.turn),
          .stops = {disturbance.stops_per_hour, disturbance.mean_stop},
          .start_delay = range(disturbance.start_delay),
          .cross_track = {disturbance.cross_track_sigma, disturbance.correlation_length}};
}

/// The base, and the candidates as far as they are above it; each once.
std::vector<core::Margins> candidates_of(const std::vector<Margins>& given,
                                         const core::PlanOptions& options) {
  const core::Margins base{options.interval_margin, options.inflation, options.wait_before_move};
  std::vector<core::Margins> candidates{base};
  for (const Margins& one : given) {
    const core::Margins margins{std::max(one.interval_margin, base.interval_margin),
                                std::max(one.inflation, base.inflation),
                                std::max(one.wait_before_move, base.wait_before_move)};
    if (std::find(candidates.begin(), candidates.end(), margins) == candidates.end()) {
      candidates.push_back(margins);
    }
  }
  return candidates;
}

core::MarginTask task_of(core::PlanTask plan, const MarginsQuestion& question) {
  std::vector<double> radii = question.body_radii;
  std::vector<double> margins = question.execution_margins;
  if (margins.empty()) margins.assign(plan.problem.robots().size(), 0.0);
  if (radii.empty()) {
    for (const core::Robot& robot : plan.problem.robots()) radii.push_back(robot.radius);
  }
  std::vector<core::Margins> candidates = candidates_of(question.candidates, plan.options);
  return {.plan = std::move(plan),
          .candidates = std::move(candidates),
          .body_radii = std::move(radii),
          .policy = static_cast<core::ExecutionPolicy>(question.policy),
          .max_delay = question.max_delay,
          .disturbance = disturbance_of(question.disturbance),
          .aim = {question.collisions, question.confidence},
          .runs = question.runs,
          .seed = question.seed,
          .dependencies = {std::move(margins), question.dependency_slack, core::kMaxTolerance}};
}

std::optional<Objectives> objectives_of(const std::optional<core::Objectives>& objectives) {
  if (!objectives) return std::nullopt;
  return Objectives{objectives->flowtime, objectives->makespan};
}

TriedMargins tried_of(const core::TriedMargins& tried) {
  return {.margins = {tried.margins.interval_margin, tried.margins.inflation, tried.margins.wait_before_move},
          .status = static_cast<TriedMargins::Status>(tried.status),
          .planned = objectives_of(tried.planned),
          .runs = tried.runs,
          .bad = tried.bad,
          .collided = tried.collided,
          .deadlocked = tried.deadlocked,
          .executed = objectives_of(tried.executed),
          .tight = tried.tight};
}

ActionProgress progress_of(const core::ActionProgress& progress) {
  return {progress.robot, progress.action, progress.fraction};
}

}  // namespace

FoundMargins find_margins(const Problem& problem, const MarginsQuestion& question, const Options& options,
                          const Control& control) {
  using Clock = core::StopCondition::Clock;
  const Clock::time_point begin = Clock::now();
  check(question, problem.robots.size());
  library::MadeProblem made = library::make_problem(problem, options, control.stop);
  if (!made.faults.empty()) throw InvalidProblem(std::move(made.faults));
  if (!made.task) return {.deterministic = false};
  const core::MarginTask task = task_of(std::move(*made.task), question);
  const core::StopCondition stop(library::end_of(options.time_budget, begin), control.stop);
  core::CallerThread thread;
  const core::FoundMargins found =
      core::find_margins(task, {.planning = core::after_share(stop, core::budget::kShareOfCandidates),
                                .stop = stop,
                                .executor = thread});
  if (found.rejected) library::throw_rejected(*found.rejected);
  if (!found.has_base()) return {.deterministic = false};
  FoundMargins result{.best = found.best, .deterministic = found.deterministic};
  for (const core::TriedMargins& tried : found.tried) result.tried.push_back(tried_of(tried));
  if (!found.plan) return result;
  result.plan = library::plan_of(found.plan->made, problem, made.invalid);
  if (found.plan->dependencies) {
    for (const core::Dependency& one : found.plan->dependencies->list) {
      result.dependencies.push_back({progress_of(one.gate), progress_of(one.until), one.slack});
    }
  }
  return result;
}

}  // namespace fleetplan
