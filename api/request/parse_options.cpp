#include "api/request/parse_options.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "api/json/object_reader.h"
#include "api/json/text.h"

namespace fleetplan::api {

namespace {

using core::PlanOptions;

constexpr std::array<std::string_view, 12> kMembers{
    "time_budget_ms",      "mode",      "objective",        "seed",      "priority",     "reordering",
    "start_safe_interval", "inflation", "wait_before_move", "any_angle", "connectivity", "max_iterations"};

constexpr std::pair<std::string_view, PlanOptions::Mode> kModes[] = {{"first", PlanOptions::Mode::first},
                                                                     {"anytime", PlanOptions::Mode::anytime}};
constexpr std::pair<std::string_view, PlanOptions::Objective> kObjectives[] = {
    {"flowtime", PlanOptions::Objective::flowtime}, {"makespan", PlanOptions::Objective::makespan}};
constexpr std::pair<std::string_view, PlanOptions::Priority> kPriorities[] = {
    {"shortest_first", PlanOptions::Priority::shortest_first},
    {"longest_first", PlanOptions::Priority::longest_first},
    {"as_listed", PlanOptions::Priority::as_listed},
    {"random", PlanOptions::Priority::random}};
constexpr std::pair<std::string_view, PlanOptions::Reordering> kReorderings[] = {
    {"raise_failed", PlanOptions::Reordering::raise_failed},
    {"random", PlanOptions::Reordering::random},
    {"none", PlanOptions::Reordering::none}};
constexpr std::array<std::uint64_t, 4> kConnectivities{4, 8, 16, 32};

// Longer ones are clamped to the server's anyway.
constexpr Range kBudget{1.0, std::numeric_limits<double>::max(), "milliseconds"};

template <typename Choice, std::size_t kCount>
void choose(const ObjectReader& reader, std::string_view key,
            const std::pair<std::string_view, Choice> (&choices)[kCount], Choice& chosen, FaultList& faults) {
  if (const JsonValue* member = reader.find(key)) {
    chosen = read_choice(*member, reader.path(key), choices, faults).value_or(chosen);
  }
}

int parse_connectivity(const JsonValue& value, const JsonPath& path, FaultList& faults) {
  const auto natural = value.natural();
  if (natural &&
      std::find(kConnectivities.begin(), kConnectivities.end(), *natural) != kConnectivities.end()) {
    return static_cast<int>(*natural);
  }
  faults.add(value, path, value.number() ? fault::kOutOfRange : fault::kWrongType,
             "connectivity must be 4, 8, 16 or 32, not " + described(value) + ".");
  return PlanOptions{}.connectivity;
}

void parse_max_iterations(const ObjectReader& reader, ReadOptions& options, FaultList& faults) {
  const JsonValue* member = reader.find("max_iterations");
  if (member == nullptr || member->is_null()) return;
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const auto iterations = read_natural(*member, reader.path("max_iterations"), kMost, faults);
  if (!iterations) return;
  options.plan.max_iterations = static_cast<std::int64_t>(*iterations);
  if (options.plan.mode == PlanOptions::Mode::first) {
    options.warnings.emplace_back("max_iterations has no effect: it bounds the mode \"anytime\" only.");
  }
}

}  // namespace

ReadOptions parse_options(const JsonValue& value, const JsonPath& path, FaultList& faults) {
  ReadOptions options;
  PlanOptions& plan = options.plan;
  const ObjectReader reader(value, path, kMembers, faults);
  if (const JsonValue* budget = reader.find("time_budget_ms")) {
    options.budget_ms = read_number(*budget, reader.path("time_budget_ms"), kBudget, faults);
  }
  choose(reader, "mode", kModes, plan.mode, faults);
  choose(reader, "objective", kObjectives, plan.objective, faults);
  if (const JsonValue* seed = reader.find("seed")) {
    constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
    plan.seed = read_natural(*seed, reader.path("seed"), kMost, faults).value_or(plan.seed);
  }
  choose(reader, "priority", kPriorities, plan.priority, faults);
  choose(reader, "reordering", kReorderings, plan.reordering, faults);
  plan.start_safe_interval = reader.number_or("start_safe_interval", kDuration, plan.start_safe_interval);
  plan.inflation = reader.number_or("inflation", kLengthOrZero, plan.inflation);
  plan.wait_before_move = reader.number_or("wait_before_move", kDuration, plan.wait_before_move);
  if (const JsonValue* any_angle = reader.find("any_angle")) {
    plan.any_angle = read_boolean(*any_angle, reader.path("any_angle"), faults).value_or(plan.any_angle);
  }
  if (const JsonValue* connectivity = reader.find("connectivity")) {
    plan.connectivity = parse_connectivity(*connectivity, reader.path("connectivity"), faults);
  }
  parse_max_iterations(reader, options, faults);
  return options;
}

std::chrono::nanoseconds effective_budget(ReadOptions& options, const Limits& limits) {
  const auto most = static_cast<double>(limits.max_budget_ms);
  const double wanted = options.budget_ms.value_or(static_cast<double>(limits.default_budget_ms));
  if (options.budget_ms && wanted > most) {
    options.warnings.push_back("time_budget_ms was clamped from " + number_text(wanted) + " to " +
                               std::to_string(limits.max_budget_ms) + ", the most that this service grants.");
  }
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double, std::milli>(std::min(wanted, most)));
}

}  // namespace fleetplan::api
