#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "api/execution/execution_requests.h"
#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"
#include "api/request/shared_members.h"
#include "core/execution/simulation/share_test.h"

namespace fleetplan::api {

namespace {

using core::ExecutionPolicy;
using core::Margins;
using core::TriedMargins;
using Status = TriedMargins::Status;

constexpr std::array<std::string_view, 8> kMarginsMembers{"request", "policy", "max_delay", "disturbance",
                                                          "aim",     "runs",   "seed",      "try"};
constexpr std::array<std::string_view, 2> kAimMembers{"collisions", "confidence"};
constexpr std::array<std::string_view, 3> kTryMembers{"interval_margin", "inflation", "wait_before_move"};
constexpr std::array<std::string_view, 2> kTryWithoutWaits{"interval_margin", "inflation"};

constexpr Range kAim{1e-4, 0.5, "of the runs"};
constexpr Range kConfidence{0.5, 0.9999, ""};
constexpr double kLeastRuns = 50.0;
constexpr Range kRunsOfMargins{kLeastRuns, static_cast<double>(kMaxRuns), "runs"};
constexpr std::size_t kUsualRuns = 20'000;
constexpr std::size_t kMaxValues = 8;
constexpr std::size_t kMaxCombinations = 64;
constexpr std::uint64_t kMaxSeedOfMargins = std::numeric_limits<std::uint64_t>::max();

/// Whether robots neither talk to each other nor keep to a common clock, so that delays add up.
bool is_blind(ExecutionPolicy policy) {
  return policy == ExecutionPolicy::open_loop || policy == ExecutionPolicy::absorb_waits;
}

bool disturbs(const core::Disturbance& disturbance) {
  const auto is_one = [](const core::UniformRange& range) { return range.min == 1.0 && range.max == 1.0; };
  const bool stops = disturbance.stops.rate_per_hour > 0.0 && disturbance.stops.mean_s > 0.0;
  return !is_one(disturbance.speed) || !is_one(disturbance.turn) || stops ||
         disturbance.start_delay.max > 0.0 || disturbance.leaves_paths();
}

core::ShareAim parse_aim(const JsonReader& member) {
  core::ShareAim aim;
  const JsonReader json = member.object(kAimMembers);
  if (!json) return aim;
  aim.share = json.find("collisions").number(kAim).value_or(aim.share);
  aim.confidence = json.find("confidence").number(kConfidence).value_or(aim.confidence);
  return aim;
}

/// The values of each margin that are tried.
struct TriedValues {
  std::vector<double> interval_margin;
  std::vector<double> inflation;
  std::vector<double> wait_before_move;

  std::size_t combinations() const {
    return interval_margin.size() * inflation.size() * wait_before_move.size();
  }
};

TriedValues usual_values(const RequestedExecution& execution) {
  TriedValues values{{0.0, 0.25, 0.5, 1.0, 2.0, 4.0}, {0.0}, {0.0}};
  if (is_blind(execution.policy)) {
    values.interval_margin = {0.0, 1.0, 4.0};
    values.wait_before_move = {0.0, 1.0, 2.0, 5.0};
  }
  if (execution.policy == ExecutionPolicy::clock_stop) {
    for (double& margin : values.interval_margin) {
      if (margin > 0.0) margin = std::min(margin + execution.max_delay, kDuration.max);
    }
  }
  if (execution.disturbance.leaves_paths()) {
    for (const double times : {2.0, 3.0, 4.0}) {
      values.inflation.push_back(
          std::min(times * execution.disturbance.cross_track.sigma, kLengthOrZero.max));
    }
  }
  return values;
}

/// Reads the values of one margin; those that are usual if there are none.
std::vector<double> parse_values(const JsonReader& member, const Range& range,
                                 const std::vector<double>& usual) {
  const JsonReader array = member.array();
  if (!array) return usual;
  if (array.size() == 0 || array.size() > kMaxValues) {
    array.fault(array.size() == 0 ? fault::kEmpty : fault::kOutOfRange,
                "The list has " + std::to_string(array.size()) + " values; give 1 to " +
                    std::to_string(kMaxValues) + ", ascending.");
    return usual;
  }
  std::vector<double> values;
  for (const JsonReader item : array.items()) {
    const auto value = item.number(range);
    if (!value) continue;
    if (!values.empty() && *value <= values.back()) {
      item.fault(fault::kOutOfRange, number_text(*value) + " does not exceed the value before it, " +
                                         number_text(values.back()) + "; the values must ascend.");
      return usual;
    }
    values.push_back(*value);
  }
  return values.empty() ? usual : values;
}

TriedValues parse_try(const JsonReader& member, const RequestedExecution& execution) {
  TriedValues values = usual_values(execution);
  const std::span<const std::string_view> known = is_blind(execution.policy)
                                                      ? std::span<const std::string_view>(kTryMembers)
                                                      : std::span<const std::string_view>(kTryWithoutWaits);
  const JsonReader json = member.object(known);
  if (!json) return values;
  values.interval_margin = parse_values(json.find("interval_margin"), kDuration, values.interval_margin);
  values.inflation = parse_values(json.find("inflation"), kLengthOrZero, values.inflation);
  if (is_blind(execution.policy)) {
    values.wait_before_move = parse_values(json.find("wait_before_move"), kDuration, values.wait_before_move);
  }
  if (values.combinations() > kMaxCombinations) {
    json.fault(fault::kOutOfRange, "There are " + std::to_string(values.combinations()) +
                                       " combinations of the values; at most " +
                                       std::to_string(kMaxCombinations) + " are tried.");
  }
  return values;
}

/// Returns the candidates: the base, and all combinations of values as far as they are above it.
std::vector<Margins> candidates_of(const TriedValues& values, const core::PlanOptions& options) {
  const Margins base{options.interval_margin, options.inflation, options.wait_before_move};
  std::vector<Margins> candidates{base};
  // Bounded: at most kMaxCombinations.
  for (const double inflation : values.inflation) {
    for (const double interval_margin : values.interval_margin) {
      for (const double wait : values.wait_before_move) {
        const Margins margins{std::max(interval_margin, base.interval_margin),
                              std::max(inflation, base.inflation), std::max(wait, base.wait_before_move)};
        if (std::find(candidates.begin(), candidates.end(), margins) == candidates.end()) {
          candidates.push_back(margins);
        }
      }
    }
  }
  return candidates;
}

/// Returns the most runs of one plan. Fewer than the aim needs are a fault.
std::size_t parse_runs_of_margins(const JsonReader& root, const core::ShareAim& aim, std::size_t candidates) {
  const auto needed = [&](std::size_t runs) { return core::ShareTest(aim, candidates, runs).least_runs(); };
  const JsonReader member = root.find("runs");
  if (member) {
    if (!member.number(kRunsOfMargins)) return kUsualRuns;
    const std::size_t runs = member.natural(kMaxRuns).value_or(kUsualRuns);
    if (runs < needed(runs)) {
      member.fault(fault::kOutOfRange, std::to_string(runs) + " runs cannot show that the aim is met: with " +
                                           std::to_string(candidates) + " candidates, it takes at least " +
                                           std::to_string(needed(runs)) + " runs without a collision.");
    }
    return runs;
  }
  const std::size_t runs = std::min(kMaxRuns, std::max(kUsualRuns, 2 * needed(kUsualRuns)));
  if (runs < needed(runs)) {
    root.find("aim").fault(fault::kOutOfRange,
                           "The aim takes at least " + std::to_string(needed(runs)) +
                               " runs without a collision, with " + std::to_string(candidates) +
                               " candidates; at most " + std::to_string(kMaxRuns) +
                               " are made: allow more collisions, less confidence or fewer candidates.");
  }
  return runs;
}

void warn_of_limits(const core::Problem& problem, std::vector<std::string>& warnings) {
  if (!problem.obstacles().empty()) {
    warnings.emplace_back(
        "Moving obstacles are not executed: collisions with them do not count, and delayed robots may meet "
        "them.");
  }
  if (!problem.zones().empty()) {
    warnings.emplace_back("Zones are not checked in executions: only robots and walls count.");
  }
}

std::optional<MarginsRequest> read_margins(const JsonReader& root, const Limits& limits, core::Work& work,
                                           core::MapCache* maps) {
  std::vector<std::string> warnings;
  const JsonReader member =
      root.require("request", "; give a request of /v1/plan").object(kPlanRequestMembers);
  const RequestedExecution execution = parse_execution(root, warnings);
  const JsonReader disturbance = root.require("disturbance", "; give what delays the robots");
  if (disturbance && root.fault_count() == 0 && !disturbs(execution.disturbance)) {
    disturbance.fault(fault::kEmpty,
                      "The disturbance disturbs nothing; give \"speed\", \"turn\", \"stops\", "
                      "\"start_delay\" or \"cross_track\" of real robots.");
  }
  const core::ShareAim aim = parse_aim(root.find("aim"));
  const TriedValues values = parse_try(root.find("try"), execution);
  const std::uint64_t seed = root.find("seed").natural(kMaxSeedOfMargins).value_or(0);
  if (!member) return std::nullopt;
  auto plan = parse_plan_request(member, limits, work, maps);
  if (!plan) return std::nullopt;
  std::vector<Margins> candidates = candidates_of(values, plan->options);
  const std::size_t runs = parse_runs_of_margins(root, aim, candidates.size());
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  warn_of_limits(plan->problem, warnings);
  if (plan->options.mode == core::PlanOptions::Mode::anytime && !plan->options.max_iterations) {
    warnings.emplace_back(
        "With \"mode\": \"anytime\", each candidate takes its whole share of the time: give max_iterations "
        "or \"mode\": \"first\".");
  }
  core::MarginTask task{
      .plan = {std::move(plan->problem), plan->options, std::move(plan->open)},
      .candidates = std::move(candidates),
      .body_radii = plan->body_radii,
      .policy = execution.policy,
      .max_delay = execution.max_delay,
      .disturbance = execution.disturbance,
      .aim = aim,
      .runs = runs,
      .seed = seed,
      .dependencies = {plan->dependencies.margins, plan->dependencies.slack, core::kMaxTolerance}};
  return MarginsRequest{std::move(*plan), std::move(task), std::move(warnings)};
}

}  // namespace

Result<MarginsRequest, RequestError> parse_margins_request(std::string_view body, const Limits& limits,
                                                           core::Work& work, core::MapCache* maps) {
  return parse_body<MarginsRequest>(
      body, limits, work, kMarginsMembers,
      [&](const JsonReader& root, core::Work& reading) { return read_margins(root, limits, reading, maps); });
}

namespace {

// In the order of core::TriedMargins::Status.
constexpr std::array<std::string_view, 5> kStatuses{"met", "not_met", "undecided", "not_planned", "not_run"};

class MarginsWriter {
 public:
  MarginsWriter(const core::FoundMargins& found, const MarginsRequest& request)
      : found_(found), request_(request), task_(request.task) {}

  std::string write(const std::optional<std::string>& plan, const std::string& request_id) {
    json_.begin_object();
    json_.member("request_id", request_id).member("met", found_.best.has_value());
    json_.key("best");
    if (found_.best) {
      json_.value(*found_.best);
    } else {
      json_.json("null");
    }
    write_options(found_.tried[best_guess()].margins);
    json_.key("plan").json(plan ? std::string_view(*plan) : std::string_view("null"));
    json_.key("tried").begin_array();
    for (const TriedMargins& tried : found_.tried) write_tried(tried);
    json_.end_array();
    write_texts("advice", advice());
    json_.member("deterministic", found_.deterministic);
    write_texts("warnings", warnings());
    json_.end_object();
    return json_.take();
  }

 private:
  std::string id(std::size_t robot) const { return robots()[robot].id; }
  const std::vector<core::Robot>& robots() const { return task_.plan.problem.robots(); }

  /// The best candidate; without one that with the least share of bad runs.
  std::size_t best_guess() const {
    if (found_.best) return *found_.best;
    std::size_t least = 0;
    for (std::size_t k = 1; k < found_.tried.size(); ++k) {
      if (found_.tried[k].runs > 0 && found_.tried[k].share() < found_.tried[least].share()) least = k;
    }
    return least;
  }

  /// The execution margin that goes with a candidate.
  double execution_margin(const Margins& margins) const {
    return std::max(request_.plan.dependencies.common_margin, margins.inflation);
  }

  void write_options(const Margins& margins) {
    json_.key("options").begin_object();
    json_.member("interval_margin", margins.interval_margin).member("inflation", margins.inflation);
    json_.member("wait_before_move", margins.wait_before_move);
    if (task_.policy == ExecutionPolicy::dependencies) {
      json_.member("dependencies", true).member("execution_margin", execution_margin(margins));
    }
    json_.end_object();
  }

  void write_objectives(std::string_view key, const std::optional<core::Objectives>& objectives) {
    json_.key(key);
    if (!objectives) {
      json_.json("null");
      return;
    }
    json_.begin_object().member("flowtime", objectives->flowtime);
    json_.member("makespan", objectives->makespan).end_object();
  }

  void write_tried(const TriedMargins& tried) {
    json_.begin_object();
    write_options(tried.margins);
    json_.member("status", kStatuses[static_cast<std::size_t>(tried.status)]);
    write_objectives("planned", tried.planned);
    json_.member("runs", tried.runs).member("bad", tried.bad);
    std::optional<double> share;
    std::optional<core::ShareInterval> interval;
    if (tried.runs > 0) {
      share = tried.share();
      interval = core::clopper_pearson(tried.bad, tried.runs, task_.aim.confidence);
    }
    json_.member("share", share);
    json_.member("share_low", interval ? std::optional(interval->low) : std::nullopt);
    json_.member("share_high", interval ? std::optional(interval->high) : std::nullopt);
    json_.member("collided", tried.collided).member("deadlocked", tried.deadlocked);
    write_objectives("executed", tried.executed);
    json_.key("tight");
    if (tried.tight) {
      json_.value(*tried.tight);
    } else {
      json_.json("null");
    }
    write_pairs(tried);
    json_.end_object();
  }

  void write_pairs(const TriedMargins& tried) {
    json_.key("pairs").begin_array();
    for (const TriedMargins::Pair& pair : tried.pairs) {
      json_.begin_object().key("robots").begin_array();
      json_.value(std::string_view(id(pair.first))).value(std::string_view(id(pair.second))).end_array();
      json_.member("runs", pair.runs);
      json_.member("share", static_cast<double>(pair.runs) / static_cast<double>(tried.runs));
      json_.end_object();
    }
    json_.end_array();
  }

  void write_texts(std::string_view key, const std::vector<std::string>& texts) {
    json_.key(key).begin_array();
    for (const std::string& text : texts) json_.value(std::string_view(text));
    json_.end_array();
  }

  std::vector<std::string> advice() const {
    std::vector<std::string> advice;
    const TriedMargins& tried = found_.tried[best_guess()];
    if (!found_.best && is_blind(task_.policy)) {
      advice.push_back("With the policy \"" + std::string(name_of(task_.policy)) +
                       "\" delays add up, and no margin lasts for long ways: execute with \"dependencies\", "
                       "by which robots wait for each other.");
    }
    if (!found_.best && tried.with_walls > 0) {
      advice.emplace_back(
          "Robots collide with walls, which no time margin changes: try more values of \"inflation\".");
    }
    if (tried.tight.value_or(0) > 0) advice.push_back(tight_text(tried));
    if (!found_.best && tried.at_rest) {
      advice.emplace_back(
          "Robots collide where they stand at their starts or last goals, which no margin of this request "
          "changes: move these poses apart.");
    }
    return advice;
  }

  std::string tight_text(const TriedMargins& tried) const {
    std::string text =
        "Robots that pass each other with less slack than their dependencies need, so that they "
        "have to keep the clock: ";
    for (std::size_t k = 0; k < tried.tight_pairs.size(); ++k) {
      const core::TightPair& pair = tried.tight_pairs[k];
      text += (k > 0 ? ", " : "") + in_quotes(id(pair.first)) + " with " + in_quotes(id(pair.second));
    }
    if (*tried.tight > tried.tight_pairs.size()) {
      text += " and " + std::to_string(*tried.tight - tried.tight_pairs.size()) + " more";
    }
    return text + ". Give an interval_margin of more than dependency_slack.";
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> warnings = request_.plan.warnings;
    warnings.insert(warnings.end(), request_.warnings.begin(), request_.warnings.end());
    if (!found_.unplanned.empty()) warnings.push_back(unplanned_text());
    if (!found_.finished) {
      warnings.emplace_back(
          "The time budget ended plans or tests, so candidates are not planned, undecided or not run: "
          "increase options.time_budget_ms of the request, or give fewer values in \"try\".");
    }
    if (found_.dropped > 0) {
      warnings.push_back("The " + std::to_string(found_.dropped) +
                         " costliest plans were not run: they do not fit in max_plan_memory of /v1/limits "
                         "beside cheaper ones. Give fewer values in \"try\".");
    }
    if (found_.best && found_.cheaper_undecided) {
      warnings.emplace_back("A cheaper candidate than the best one is undecided: give more runs.");
    }
    if (found_.best && has_smaller_margins(found_.tried[*found_.best].margins)) {
      warnings.emplace_back(
          "Robots have an execution_margin of their own that is less than the inflation; the plan was "
          "executed "
          "with the inflation. Raise or leave out robots[].execution_margin when you set the options.");
    }
    return warnings;
  }

  std::string unplanned_text() const {
    constexpr std::size_t kMaxNamed = 5;
    const core::RobotList& unplanned = found_.unplanned;
    std::string text = "Robots without a plan, also with the request's own options: ";
    const std::size_t named = std::min(kMaxNamed, unplanned.size());
    for (std::size_t k = 0; k < named; ++k) text += (k > 0 ? ", " : "") + in_quotes(id(unplanned[k]));
    if (unplanned.total() > named) text += " and " + std::to_string(unplanned.total() - named) + " more";
    return text + ". The figures are those of the other robots.";
  }

  bool has_smaller_margins(const Margins& margins) const {
    if (task_.policy != ExecutionPolicy::dependencies) return false;
    const RequestedDependencies& requested = request_.plan.dependencies;
    for (std::size_t robot = 0; robot < requested.margins.size(); ++robot) {
      if (requested.has_own[robot] && requested.margins[robot] < margins.inflation) return true;
    }
    return false;
  }

  const core::FoundMargins& found_;
  const MarginsRequest& request_;
  const core::MarginTask& task_;
  JsonWriter json_;
};

}  // namespace

std::string write_margins(const core::FoundMargins& found, const MarginsRequest& request,
                          const std::optional<std::string>& plan, const std::string& request_id) {
  return MarginsWriter(found, request).write(plan, request_id);
}

}  // namespace fleetplan::api
