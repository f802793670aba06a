#pragma once

// The options of a request in one table. The parser and the schema PlanOptions of api/openapi.json follow it.
// The page and the documentation follow the schema.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "core/model/plan_options.h"

namespace fleetplan::api {

/// What to do with robots whose poses are at fault: refuse the request, or report them as invalid and plan
/// all others.
enum class InvalidRobots { refuse, report };

/// The member `options` of a request.
struct ParsedOptions {
  core::PlanOptions plan;
  InvalidRobots invalid_robots = InvalidRobots::refuse;
  bool dependencies = false;          // the answer has dependencies
  double dependency_slack = 0.1;      // seconds, > 0
  double execution_margin = 0.0;      // metres, >= 0; a robot's own margin takes precedence
  std::optional<double> budget_ms;    // milliseconds, as requested, >= 1; none: the service's default
  std::vector<std::string> warnings;  // about options that are accepted, but have not the expected effect
};

/// A member of the plan options.
template <typename Value>
using OptionField = Value core::PlanOptions::*;

/// A real number.
struct RealOption {
  Range range;
  OptionField<double> field;
};

/// A real number whose default is a setting of the service.
struct ServiceOption {
  using Field = std::optional<double> ParsedOptions::*;
  Range range;
  Field field;
  double example;
};

/// A whole number from 0 to `max`.
struct NaturalOption {
  std::uint64_t max;
  OptionField<std::uint64_t> field;
};

/// A whole number from 0 to `max`, or null for no bound. null is the default.
struct BoundOption {
  std::uint64_t max;
  OptionField<std::optional<std::int64_t>> field;
};

/// A real number, or null if the planner is to choose. null is the default.
struct ChosenOption {
  Range range;
  OptionField<std::optional<double>> field;
};

/// One of a few numbers.
struct CountOption {
  std::span<const int> values;
  OptionField<int> field;
};

struct BooleanOption {
  OptionField<bool> field;
};

/// A real number, and below a boolean. They affect only the answer, not the plan.
struct AnswerRealOption {
  Range range;
  double ParsedOptions::*field;
};
struct AnswerBooleanOption {
  bool ParsedOptions::*field;
};

/// One of a few words, each with its meaning, in the order of the enumeration.
struct WordOption {
  struct Word {
    std::string_view name;
    std::string_view meaning;
  };
  std::span<const Word> words;
  std::size_t (*get)(const ParsedOptions&);
  void (*set)(ParsedOptions&, std::size_t);
};

struct OptionRow {
  std::string_view name;
  std::string_view title;  // title of the field in a form
  std::string_view unit;   // symbol, e.g. "ms"; empty: none
  std::variant<RealOption, ChosenOption, ServiceOption, NaturalOption, BoundOption, CountOption,
               BooleanOption, AnswerRealOption, AnswerBooleanOption, WordOption>
      type;
  std::string_view description;  // CommonMark
};

/// Returns all options. The defaults equal the defaults of ParsedOptions.
std::span<const OptionRow> option_table();

/// Reads the member `options`, by the table of options. Missing options have their defaults.
ParsedOptions parse_options(const JsonReader& member);

/// Returns the requested budget, or the default budget, but at most the service's maximum.
std::chrono::nanoseconds effective_budget(const ParsedOptions& options, const Limits& limits);

/// Returns the warning that the budget is less than requested; none if it is not less.
std::optional<std::string> budget_warning(const ParsedOptions& options, const Limits& limits);

/// Whether the answer is to have dependencies, and which.
struct RequestedDependencies {
  bool wanted = false;          // the answer with a plan has dependencies
  double slack = 0.1;           // seconds, > 0
  std::vector<double> margins;  // by robot: metres, >= 0
  double common_margin = 0.0;   // metres, of robots that have none of their own
  std::vector<bool> has_own;    // by robot: whether it has a margin of its own
};

}  // namespace fleetplan::api
