#include "api/request/parse_options.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/json/faults.h"

namespace fleetplan::api {

namespace {

/// "4, 8, 16 or 32".
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
  ReadOptions options() const { return options_; }

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
    set(option.field, member.natural(option.most));
  }
  void read(const BoundOption& option, const JsonReader& member) {
    if (member.is_null()) return;
    if (const auto bound = member.natural(option.most)) {
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
  ReadOptions options_;
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

ReadOptions parse_options(const JsonReader& member) {
  std::vector<std::string_view> names;
  for (const OptionRow& row : option_table()) names.push_back(row.name);
  OptionReader reader(member.object(names));
  for (const OptionRow& row : option_table()) reader.read(row);
  ReadOptions options = reader.options();
  if (options.plan.max_iterations && options.plan.mode == core::PlanOptions::Mode::first) {
    options.warnings.emplace_back("max_iterations has no effect: it bounds the mode \"anytime\" only.");
  }
  return options;
}

std::chrono::nanoseconds effective_budget(const ReadOptions& options, const Limits& limits) {
  const double wanted = options.budget_ms.value_or(static_cast<double>(limits.default_budget_ms));
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double, std::milli>(std::min(wanted, static_cast<double>(limits.max_budget_ms))));
}

std::optional<std::string> budget_warning(const ReadOptions& options, const Limits& limits) {
  if (!options.budget_ms || *options.budget_ms <= static_cast<double>(limits.max_budget_ms)) {
    return std::nullopt;
  }
  return "time_budget_ms was clamped from " + number_text(*options.budget_ms) + " to " +
         std::to_string(limits.max_budget_ms) + ", the maximum of this service.";
}

}  // namespace fleetplan::api
