#include "api/request/options.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "api/json/errors.h"
#include "api/request/limits.h"

namespace fleetplan::api {

namespace {

using core::PlanOptions;
using Word = WordOption::Word;

// The range of the budget. A longer one is clamped to the service's maximum.
constexpr Range kBudget{1.0, std::numeric_limits<double>::max(), "milliseconds"};
constexpr std::uint64_t kMaxSeed = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMaxIterations = std::numeric_limits<std::int64_t>::max();

constexpr std::array<Word, 2> kModes{{
    {"first", "First solution"},
    {"anytime", "Improve until the budget ends"},
}};
constexpr std::array<Word, 3> kObjectives{{
    {"flowtime", "Flowtime (sum)"},
    {"makespan", "Makespan (maximum)"},
    {"tardiness", "Tardiness (sum of delays)"},
}};
constexpr std::array<Word, 4> kPriorities{{
    {"shortest_first", "Shortest path first"},
    {"longest_first", "Longest path first"},
    {"as_listed", "As listed"},
    {"random", "Random"},
}};
constexpr std::array<Word, 3> kReorderings{{
    {"raise_failed", "Plan the failed robot first"},
    {"random", "Shuffle"},
    {"none", "Plan every robot once"},
}};
constexpr std::array<int, 4> kConnectivities{4, 8, 16, 32};

constexpr std::array<Word, 2> kReplans{{
    {"all", "Improve all plans"},
    {"where_needed", "Change only what must change"},
}};
constexpr std::array<Word, 2> kInvalidRobots{{
    {"refuse", "Refuse the request"},
    {"report", "Report them, plan the others"},
}};

template <auto kField>
constexpr WordOption one_of(std::span<const Word> words) {
  return {words, [](const ParsedOptions& options) { return static_cast<std::size_t>(options.plan.*kField); },
          [](ParsedOptions& options, std::size_t index) {
            options.plan.*kField = static_cast<std::decay_t<decltype(options.plan.*kField)>>(index);
          }};
}

constexpr WordOption one_of_invalid_robots() {
  return {kInvalidRobots,
          [](const ParsedOptions& options) { return static_cast<std::size_t>(options.invalid_robots); },
          [](ParsedOptions& options, std::size_t index) {
            options.invalid_robots = static_cast<InvalidRobots>(index);
          }};
}

constexpr std::array<OptionRow, 23> kTable{{
    {"time_budget_ms", "Time budget", "ms", ServiceOption{kBudget, &ParsedOptions::budget_ms, 5000.0},
     "Milliseconds for the whole answer, counted from the last byte received. `GET /v1/limits` returns the "
     "default (`default_budget_ms`) and the maximum (`max_budget_ms`); a larger value is clamped, with a "
     "warning."},
    {"mode", "Mode", "", one_of<&PlanOptions::mode>(kModes),
     "`first` returns the first solution; `anytime` uses the rest of the budget to improve the objective."},
    {"objective", "Objective", "", one_of<&PlanOptions::objective>(kObjectives),
     "What `anytime` minimizes. `flowtime`: the sum of the robots' costs, each times its `weight`. "
     "`makespan`: "
     "the greatest cost. `tardiness`: the sum of how much later than `due` they arrive at goals, each times "
     "`weight`; among plans of equal tardiness, the lower flowtime."},
    {"seed", "Seed", "", NaturalOption{kMaxSeed, &PlanOptions::seed}, "Seed of all random choices."},
    {"priority", "Initial order", "", one_of<&PlanOptions::priority>(kPriorities),
     "The initial order in which robots are planned. Later robots give way to earlier ones."},
    {"reordering", "After a failure", "", one_of<&PlanOptions::reordering>(kReorderings),
     "How the order changes when no plan is found for a robot. `none` plans every robot just once."},
    {"start_safe_interval", "Start safe interval", "s",
     RealOption{kDuration, &PlanOptions::start_safe_interval},
     "Seconds for which the starts of robots that are not planned yet, or the ends of their committed "
     "actions, are kept free. If any robot has `committed` or `previous`, the default is 0, or 1 with a "
     "`horizon`."},
    {"inflation", "Inflation", "m", RealOption{kLengthOrZero, &PlanOptions::inflation},
     "Metres added to every radius during planning. A robot that is too near to others at its start may "
     "leave, but comes no nearer. A robot that fits its goal only without the inflation stays unplanned."},
    {"wait_before_move", "Wait before a move", "s", RealOption{kDuration, &PlanOptions::wait_before_move},
     "Seconds that a robot stands still before every translation, already turned."},
    {"any_angle", "Any angle", "", BooleanOption{&PlanOptions::any_angle},
     "Allows straight moves between any two cells in line of sight, not only between neighbours."},
    {"smoothing", "Smoothing", "", BooleanOption{&PlanOptions::smoothing},
     "Lets robots stop between the points of the lattice where that makes paths shorter: with `any_angle` "
     "and "
     "without a `horizon`. `false`: besides starts and goals, they stop at its points alone."},
    {"connectivity", "Connectivity", "", CountOption{kConnectivities, &PlanOptions::connectivity},
     "Number of neighbours of a cell. With `any_angle`, later improvement of `anytime` may have more, up to "
     "32."},
    {"max_iterations", "Improvement steps", "", BoundOption{kMaxIterations, &PlanOptions::max_iterations},
     "Bounds `anytime` by a number of improvement steps instead of the clock."},
    {"replan", "Previous plans", "", one_of<&PlanOptions::replan>(kReplans),
     "How `previous` plans that still hold are used. `all`: the search begins with them and improves them. "
     "`where_needed`: they are kept, unless a robot could not be planned otherwise."},
    {"horizon", "Horizon", "s", ChosenOption{kHorizon, &PlanOptions::horizon},
     "Seconds up to which conflicts are resolved. A plan may stop there before its goal, with `ends_at` "
     "`horizon` and its `estimated_cost`, where the robot may rest for good; the next plan goes on from it. "
     "By default, whole ways are planned."},
    {"interval_margin", "Time margin", "s", RealOption{kDuration, &PlanOptions::interval_margin},
     "Seconds by which robots may be early or late without a collision: any two keep clear of each other at "
     "times that differ by up to so much. Not between committed motions, nor of robots that have not left "
     "their start or the end of their committed actions."},
    {"start_overlap", "Overlap at the start", "m", RealOption{kLengthOrZero, &PlanOptions::start_overlap},
     "Metres by which measured starts may overlap each other or a wall, inflation included. Such robots come "
     "no nearer until they are clear."},
    {"goal_overlap", "Overlap at the goal", "m", RealOption{kLengthOrZero, &PlanOptions::goal_overlap},
     "Metres by which robots may overlap a wall at their last goals, as in docks, inflation included. They "
     "come no nearer than they are there on their straight way in, and may start there the next time."},
    {"invalid_robots", "Invalid robots", "", one_of_invalid_robots(),
     "What to do with robots whose poses or committed actions collide. `refuse` answers 422. `report` lists "
     "them in `unplanned` with the reason `invalid` and their `errors`. They are obstacles at their starts, "
     "and the others are planned."},
    {"lattice_spacing", "Lattice spacing", "m", ChosenOption{kLength, &PlanOptions::lattice_spacing},
     "Metres between the points at which robots may stop besides their starts and goals. By default, the "
     "resolution of the map; for a robot whose radius is at least four cells, about this radius. Clearance "
     "to obstacles is exact in any case."},
    {"dependencies", "Dependencies", "", AnswerBooleanOption{&ParsedOptions::dependencies},
     "Adds `dependencies` and `tight` to the answer: which robot has to wait for which other one, and where, "
     "when robots execute the plan at their own pace. See docs/execution.md."},
    {"dependency_slack", "Slack of dependencies", "s",
     AnswerRealOption{kSlackInTime, &ParsedOptions::dependency_slack},
     "Slack of each dependency in seconds: if robots are on time, the robot that opens a gate does so by "
     "this "
     "time before the other robot comes there. A dependency may have half of it. Smaller than "
     "`interval_margin`."},
    {"execution_margin", "Margin of execution", "m",
     AnswerRealOption{kLengthOrZero, &ParsedOptions::execution_margin},
     "Metres added to the radius of each robot in dependencies, unless it has its own `execution_margin`: "
     "how far its real path may be off the planned one. Smaller than `inflation`."},
}};

}  // namespace

std::span<const OptionRow> option_table() { return kTable; }

namespace {

/// Returns numbers as alternatives: "4, 8, 16 or 32".
std::string alternatives(std::span<const int> values) {
  std::string text;
  for (std::size_t index = 0; index < values.size(); ++index) {
    if (index > 0) text += index + 1 == values.size() ? " or " : ", ";
    text += std::to_string(values[index]);
  }
  return text;
}

/// Reads one member into the options, according to its row in the table.
class OptionReader {
 public:
  explicit OptionReader(const JsonReader& options) : json_(options) {}

  void read(const OptionRow& row) {
    const JsonReader member = json_.find(row.name);
    if (member) std::visit([&](const auto& option) { read(option, member); }, row.type);
  }
  ParsedOptions options() const { return options_; }

 private:
  template <typename Value>
  void set(OptionField<Value> field, const std::optional<Value>& value) {
    if (value) options_.plan.*field = *value;
  }
  void read(const RealOption& option, const JsonReader& member) {
    set(option.field, member.number(option.range));
  }
  void read(const ChosenOption& option, const JsonReader& member) {
    if (member.is_null()) return;
    options_.plan.*option.field = member.number(option.range);
  }
  void read(const ServiceOption& option, const JsonReader& member) {
    options_.*option.field = member.number(option.range);
  }
  void read(const NaturalOption& option, const JsonReader& member) {
    set(option.field, member.natural(option.max));
  }
  void read(const BoundOption& option, const JsonReader& member) {
    if (member.is_null()) return;
    if (const auto bound = member.natural(option.max)) {
      options_.plan.*option.field = static_cast<std::int64_t>(*bound);
    }
  }
  void read(const AnswerRealOption& option, const JsonReader& member) {
    if (const auto value = member.number(option.range)) options_.*option.field = *value;
  }
  void read(const AnswerBooleanOption& option, const JsonReader& member) {
    if (const auto value = member.boolean()) options_.*option.field = *value;
  }
  void read(const BooleanOption& option, const JsonReader& member) { set(option.field, member.boolean()); }
  void read(const CountOption& option, const JsonReader& member);
  void read(const WordOption& option, const JsonReader& member);

  JsonReader json_;
  ParsedOptions options_;
};

void OptionReader::read(const CountOption& option, const JsonReader& member) {
  const auto natural = member.natural();
  const auto same = [&](int value) { return natural && *natural == static_cast<std::uint64_t>(value); };
  const auto found = std::find_if(option.values.begin(), option.values.end(), same);
  if (found != option.values.end()) {
    options_.plan.*option.field = *found;
  } else {
    member.must_be(member.is_number() ? fault::kOutOfRange : fault::kWrongType, alternatives(option.values));
  }
}

void OptionReader::read(const WordOption& option, const JsonReader& member) {
  std::vector<std::string_view> words;
  for (const WordOption::Word& word : option.words) words.push_back(word.name);
  if (const auto index = member.word(words)) option.set(options_, *index);
}

}  // namespace

ParsedOptions parse_options(const JsonReader& member) {
  std::vector<std::string_view> names;
  for (const OptionRow& row : option_table()) names.push_back(row.name);
  OptionReader reader(member.object(names));
  for (const OptionRow& row : option_table()) reader.read(row);
  ParsedOptions options = reader.options();
  if (options.plan.max_iterations && options.plan.mode == core::PlanOptions::Mode::first) {
    options.warnings.emplace_back("max_iterations has no effect: it bounds the mode \"anytime\" only.");
  }
  return options;
}

std::chrono::nanoseconds effective_budget(const ParsedOptions& options, const Limits& limits) {
  const double wanted = options.budget_ms.value_or(static_cast<double>(limits.default_budget_ms));
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double, std::milli>(std::min(wanted, static_cast<double>(limits.max_budget_ms))));
}

std::optional<std::string> budget_warning(const ParsedOptions& options, const Limits& limits) {
  if (!options.budget_ms || *options.budget_ms <= static_cast<double>(limits.max_budget_ms)) {
    return std::nullopt;
  }
  return "time_budget_ms was clamped from " + number_text(*options.budget_ms) + " to " +
         std::to_string(limits.max_budget_ms) + ", the maximum of this service.";
}

}  // namespace fleetplan::api
