#include "core/lns/iterations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/geometry/elementary_functions.h"
#include "core/lns/smoothing.h"

namespace fleetplan::core {
namespace {

/// The share of the latest try in a moving average.
constexpr double kLatestShare = 0.02;
/// An alternative without recent gain counts as if its rate were this share of the best rate.
constexpr double kLeastShare = 0.1;

}  // namespace

double AdaptiveChoice::rate(const Record& record) const { return record.gain / record.effort; }

std::vector<double> AdaptiveChoice::weights(std::size_t count) const {
  const std::span records(records_.data(), count);
  double best = 0.0;
  for (const Record& record : records) {
    if (record.effort > 0.0) best = std::max(best, rate(record));
  }
  std::vector<double> weights;
  weights.reserve(count);
  for (const Record& record : records) {
    // The effort, not the number of tries, is proportional to the rate.
    if (best == 0.0 || record.effort == 0.0) {
      weights.push_back(record.effort == 0.0 ? -1.0 : 1.0 / record.effort);
    } else {
      weights.push_back(std::max(rate(record), kLeastShare * best) / record.effort);
    }
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  for (double& weight : weights) {
    if (weight < 0.0) weight = most > 0.0 ? most : 1.0;  // not tried yet: equal to the best
  }
  return weights;
}

std::size_t AdaptiveChoice::choose(Random& random, std::size_t count) const {
  const std::vector<double> weights = this->weights(count);
  double remaining = 0.0;
  for (const double weight : weights) remaining += weight;
  remaining *= random.unit();
  for (std::size_t alternative = 0; alternative < weights.size(); ++alternative) {
    remaining -= weights[alternative];
    if (remaining < 0.0) return alternative;
  }
  return weights.size() - 1;
}

void AdaptiveChoice::learn(std::size_t alternative, double gain, double effort) {
  Record& record = records_[alternative];
  const double share = record.effort == 0.0 ? 1.0 : kLatestShare;
  record.gain += share * (gain - record.gain);
  record.effort += share * (effort - record.effort);
}

namespace {

/// The weight of a robot's earlier failures after a gain: it may gain more.
constexpr double kFailureWeightAfterGain = 0.5;

}  // namespace

std::size_t DelayedChoice::choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                                  Random& random) const {
  std::vector<double> weights;
  weights.reserve(robots.size());
  double remaining = 0.0;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    weights.push_back(delays[k] / (1.0 + failures_[robots[k]]));
    remaining += weights.back();
  }
  remaining *= random.unit();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    remaining -= weights[k];
    if (remaining < 0.0) return robots[k];
  }
  return robots.back();
}

void DelayedChoice::learn(std::size_t robot, bool gained) {
  if (gained) {
    failures_[robot] *= kFailureWeightAfterGain;
  } else {
    failures_[robot] += 1.0;
  }
}

namespace {

constexpr std::array<std::size_t, 5> kSizes{1, 2, 4, 8, 16};
/// Weighted searches with few expansions find most of what can be found, and fail soon. The other searches
/// are for the rest.
constexpr std::array<SearchSettings, 3> kLimits{{
    {.heuristic_weight = 1.5, .thorough = false, .max_expansions = 400},
    {.heuristic_weight = 1.5, .thorough = false, .max_expansions = 8'000},
    {.heuristic_weight = 1.0,
     .suboptimality = 0.0,
     .suboptimality_growth = 0.0,
     .dominance_slack = 0.0,
     .thorough = false,
     .max_expansions = 40'000},
}};

}  // namespace

AdaptiveParameters::Choice AdaptiveParameters::Choice::smoothing() {
  Choice choice;
  choice.settings = kLimits.size();
  return choice;
}

std::size_t AdaptiveParameters::Choice::robots() const { return search_settings() ? kSizes[size] : 1; }

std::optional<SearchSettings> AdaptiveParameters::Choice::search_settings() const {
  if (settings == kLimits.size()) return std::nullopt;
  return kLimits[settings];
}

AdaptiveParameters::AdaptiveParameters()
    : kinds_(kNeighbourhoods), sizes_(kSizes.size()), limits_(kLimits.size() + 1) {}

AdaptiveParameters::Choice AdaptiveParameters::choose(Random& random, bool may_smooth) const {
  Choice choice;
  choice.kind = kinds_.choose(random);
  choice.size = sizes_.choose(random);
  choice.settings = limits_.choose(random, kLimits.size() + (may_smooth ? 1 : 0));
  return choice;
}

void AdaptiveParameters::learn(const Choice& choice, double gain, double effort) {
  limits_.learn(choice.settings, gain, effort);
  if (!choice.search_settings()) return;  // the others had no effect
  kinds_.learn(choice.kind, gain, effort);
  sizes_.learn(choice.size, gain, effort);
}

namespace {

/// A delay below this is rounding, weighted seconds.
constexpr double kLeastDelay = 1e-9;
/// The limits of a search that finds the cheapest path that the searches can find. Dominance and estimates
/// may lose cheaper paths.
constexpr SearchSettings kProof{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};
/// The tries to smooth the path that such a search finds, and the path that the robot has; and seconds: what
/// they gain, if anything.
constexpr int kTriesOfProof = 1000;
constexpr double kLeastSmoothed = 1e-4;
/// The effort for tests whether a robot can become cheaper: expansions at first, and as a share of the
/// expansions of the search.
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

std::optional<Exhaustion::Test> Exhaustion::next_test(std::int64_t effort) {
  const std::int64_t max_expansions = kFirstProofExpansions + effort / kProofShare - expansions_;
  if (is_testing_ || max_expansions <= 0) return std::nullopt;
  const std::vector<std::size_t>& planned = incumbent_.planned();
  for (std::size_t k = 0; k < planned.size(); ++k) {
    const std::size_t robot = planned[next_to_test_++ % planned.size()];
    if (!may_gain(robot)) continue;
    is_testing_ = true;
    Test test;
    test.robot = robot;
    test.version = incumbent_.version(robot);
    test.moves = moves_;
    test.bound = incumbent_.cost_with_share(robot, incumbent_.share(robot) - kLeastDelay);
    // Without a bound: the search discards by estimates, which may be too high.
    test.settings = kProof;
    test.settings.max_expansions = max_expansions;
    test.seed = ++tests_;
    return test;
  }
  return std::nullopt;
}

void Exhaustion::run(Test& test, PlanState& state, const StopCondition& stop) const {
  SearchResult result = state.plan_ignoring(test.robot, incumbent_.planned(), test.settings, stop);
  if (result.trajectory && incumbent_.may_smooth()) {
    const IgnoredRobots absent(state.reservations(), incumbent_.planned());
    Random random(test.seed);
    Trajectory now = *state.reservations().trajectory(test.robot);
    for (Trajectory* path : {&*result.trajectory, &now}) {
      Smoothed smoothed = smooth(state, test.robot, *path, kTriesOfProof, random, stop);
      result.expansions += smoothed.timed;
      if (smoothed.trajectory) *path = std::move(*smoothed.trajectory);
    }
    if (now.cost < result.trajectory->cost) result.trajectory = std::move(now);
    if (stop.met()) result.complete = false;
  }
  test.result = std::move(result);
}

void Exhaustion::learn(const Test& test) {
  is_testing_ = false;
  expansions_ += test.result.expansions;
  const double least_gain = incumbent_.may_smooth() ? kLeastSmoothed : 0.0;
  const bool is_cheaper = test.result.trajectory && test.result.trajectory->cost < test.bound - least_gain;
  const bool is_proof = !is_cheaper && test.result.complete && test.moves == moves_;
  if (is_proof) cheapest_[test.robot] = test.version;
}

bool Exhaustion::has_proofs() const {
  return std::any_of(cheapest_.begin(), cheapest_.end(),
                     [](const auto& version) { return version.has_value(); });
}

void Exhaustion::forget() {
  ++moves_;
  cheapest_.assign(cheapest_.size(), std::nullopt);
}

namespace {

/// The share of its delay that the first robot has to gain in most iterations: the higher, the sooner a
/// search fails. Small gains count too, so one iteration in kIterationsPerAnyGain accepts any gain.
constexpr double kMinGainShare = 0.15;
constexpr std::size_t kIterationsPerAnyGain = 4;
/// Much smoothing starts after this many searches per robot, or earlier, once as many searches as there are
/// robots have failed. At first, searches gain more.
constexpr std::int64_t kSearchesPerRobot = 50;
/// The tries to smooth a path until then.
constexpr int kFewTries = 25;
/// A change may make the flowtime longer by this share of the robots' mean delay. This leads out of local
/// optima (threshold accepting; Dueck and Scheuer, 1990).
constexpr double kMaxLossShare = 0.2;
/// Vain iterations for each robot until the search strays: from then on, the loss doubles with as many
/// iterations as there are robots. After kDoublings it returns to the best plan, and strays again.
constexpr int kPatience = 4;
constexpr int kDoublings = 8;

}  // namespace

void SmoothingTurns::begin(std::vector<std::size_t> robots) {
  robots_ = std::move(robots);
  position_ = in_vain_ = 0;
}

std::optional<std::size_t> SmoothingTurns::next(const std::function<bool(std::size_t)>& may_gain) {
  for (std::size_t k = 0; k < robots_.size(); ++k) {
    const std::size_t robot = robots_[position_++ % robots_.size()];
    if (may_gain(robot)) return robot;
  }
  robots_.clear();
  return std::nullopt;
}

void SmoothingTurns::learn(bool gained) {
  in_vain_ = gained ? 0 : in_vain_ + 1;
  if (in_vain_ >= robots_.size()) robots_.clear();
}

Iteration Iterations::choose() {
  Iteration iteration;
  iteration.version = incumbent_.version();
  const auto robots = static_cast<std::int64_t>(incumbent_.planned().size());
  is_late_ = is_late_ || vain_ >= robots || searches_ >= kSearchesPerRobot * robots;
  const auto may_gain = [&](std::size_t robot) { return exhaustion_.delay(robot) > kLeastDelay; };
  const std::optional<std::size_t> smoothed = turns_.next(may_gain);
  iteration.parameters = smoothed ? AdaptiveParameters::Choice::smoothing()
                                  : parameters_.choose(random_, is_late_ && incumbent_.may_smooth());
  iteration.options.settings = iteration.parameters.search_settings();
  const bool searches = iteration.options.settings.has_value();
  if (!is_late_) iteration.options.tries = kFewTries;
  if (searches && random_.below(kIterationsPerAnyGain) != 0) iteration.options.min_gain_share = kMinGainShare;
  iteration.seed = random_.seed();
  if (!for_makespan_) iteration.options.max_loss = max_loss();
  if (for_makespan_) iteration.options.cost_limit = incumbent_.makespan();
  if (smoothed) {
    iteration.first = *smoothed;
  } else if (for_makespan_ && random_.below(2) == 0) {
    iteration.options.gain = NeighbourhoodOptions::Gain::first;
    iteration.first = incumbent_.last_to_arrive();
  } else {
    iteration.first = choose_delayed(searches ? first_robots_ : smoothed_robots_);
  }
  return iteration;
}

void Iterations::begin_smoothing() {
  if (!incumbent_.may_smooth()) return;
  return_to_best();
  is_late_ = true;
  std::vector<std::size_t> robots = incumbent_.planned();
  const auto urgency = [&](std::size_t robot) {
    return for_makespan_ ? incumbent_.cost(robot) : exhaustion_.delay(robot);
  };
  std::stable_sort(robots.begin(), robots.end(),
                   [&](std::size_t a, std::size_t b) { return urgency(a) > urgency(b); });
  turns_.begin(std::move(robots));
}

double Iterations::max_loss() const {
  const auto count = static_cast<double>(incumbent_.planned().size());
  double delays = 0.0;
  for (const std::size_t robot : incumbent_.planned()) delays += exhaustion_.delay(robot);
  return kMaxLossShare * delays / count * power_of_two(static_cast<double>(straying_) / count);
}

std::size_t Iterations::choose_delayed(const DelayedChoice& choice) {
  std::vector<double> delays;
  delays.reserve(incumbent_.planned().size());
  for (const std::size_t robot : incumbent_.planned()) delays.push_back(exhaustion_.delay(robot));
  return choice.choose(incumbent_.planned(), delays, random_);
}

void Iterations::run(Iteration& iteration, Workspace& workspace) const {
  Random random(iteration.seed);
  const AdaptiveParameters::Choice& parameters = iteration.parameters;
  const auto robots = workspace.neighbourhoods().select(iteration.first, parameters.neighbourhood(),
                                                        parameters.robots(), random);
  iteration.result = plan_neighbourhood(workspace.state(), robots, bounds_, iteration.options, random, stop_);
}

bool Iterations::accept(Iteration& iteration, Workspace& workspace) {
  const bool is_best = adopt(iteration, workspace);
  if (!iteration.options.settings) {
    turns_.learn(is_best);
    return is_best;
  }
  ++searches_;
  ++vain_;
  if (is_best) {
    vain_ = straying_ = 0;
  } else if (!for_makespan_) {
    stray();
  }
  return is_best;
}

bool Iterations::adopt(Iteration& iteration, Workspace& workspace) {
  std::optional<Change>& change = iteration.result.change;
  // While all robots are smoothed, no earlier search may lead away from the best plan.
  const bool may_adopt = change && (turns_.are_over() || change->gain > 0.0);
  const bool adopted = may_adopt && !is_outdated(iteration, workspace);
  learn(iteration);
  if (!adopted) return false;
  for (Change::Part& part : change->parts) {
    if (iteration.options.settings) smoothed_robots_.forget(part.robot);
    best_.replace(part.robot, std::move(part.trajectory));
  }
  return best_.changed(change->gain);
}

/// Small changes that gain do not lead out of every plan, so the search strays farther and farther, until it
/// returns to the best plan.
void Iterations::stray() {
  const auto robots = static_cast<std::int64_t>(incumbent_.planned().size());
  if (vain_ > kPatience * robots && ++straying_ == kDoublings * robots) return_to_best();
}

bool Iterations::return_to_best() {
  straying_ = 0;
  if (best_.differences().empty()) return false;
  best_.restore();
  return true;
}

void Iterations::learn(const Iteration& iteration) {
  const NeighbourhoodResult& result = iteration.result;
  const double gain = result.change ? std::max(0.0, result.change->gain) : 0.0;
  parameters_.learn(iteration.parameters, gain, result.effort);
  DelayedChoice& robots = iteration.options.settings ? first_robots_ : smoothed_robots_;
  robots.learn(iteration.first, result.change.has_value());
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
    const auto conflicting = workspace.state().reservations().conflicting_robots(part.robot, part.trajectory);
    return !std::all_of(conflicting.begin(), conflicting.end(), is_part);
  });
}

}  // namespace fleetplan::core
