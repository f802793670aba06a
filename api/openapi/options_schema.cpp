#include "api/openapi/options_schema.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>

#include "api/request/option_table.h"

namespace fleetplan::api {

namespace {

using Json = nlohmann::ordered_json;

const ReadOptions kDefaults;

/// Whole numbers without a decimal point.
Json number(double value) {
  constexpr double kLargestWhole = 1e15;
  if (std::abs(value) > kLargestWhole || std::floor(value) != value) return value;
  return static_cast<std::int64_t>(value);
}

Json with_range(Json schema, const Range& range) {
  schema["minimum"] = number(range.least);
  schema["maximum"] = number(range.most);
  return schema;
}

Json schema_of(const RealOption& option) {
  Json schema = with_range({{"type", "number"}}, option.range);
  schema["default"] = number(kDefaults.plan.*option.field);
  return schema;
}

Json schema_of(const ChosenOption& option) {
  Json schema = with_range({{"type", Json::array({"number", "null"})}}, option.range);
  schema["default"] = nullptr;
  return schema;
}

Json schema_of(const ServiceOption& option) {
  Json schema = with_range({{"type", "number"}}, option.range);
  schema["examples"] = Json::array({number(option.example)});
  return schema;
}

Json schema_of(const NaturalOption& option) {
  return {{"type", "integer"},
          {"minimum", 0},
          {"maximum", option.most},
          {"default", kDefaults.plan.*option.field}};
}

Json schema_of(const BoundOption& option) {
  return {{"type", Json::array({"integer", "null"})},
          {"minimum", 0},
          {"maximum", option.most},
          {"default", nullptr}};
}

Json schema_of(const CountOption& option) {
  return {{"type", "integer"}, {"enum", option.values}, {"default", kDefaults.plan.*option.field}};
}

Json schema_of(const BooleanOption& option) {
  return {{"type", "boolean"}, {"default", kDefaults.plan.*option.field}};
}

Json schema_of(const AnswerRealOption& option) {
  Json schema = with_range({{"type", "number"}}, option.range);
  schema["default"] = number(kDefaults.*option.field);
  return schema;
}

Json schema_of(const AnswerBooleanOption& option) {
  return {{"type", "boolean"}, {"default", kDefaults.*option.field}};
}

Json schema_of(const WordOption& option) {
  Json names = Json::array();
  Json meanings;
  for (const WordOption::Word& word : option.words) {
    names.push_back(word.name);
    meanings[std::string(word.name)] = word.meaning;
  }
  const auto standard = option.words[option.get(kDefaults)].name;
  return {{"type", "string"}, {"enum", names}, {"x-enumDescriptions", meanings}, {"default", standard}};
}

Json schema_of(const OptionRow& row) {
  Json schema{{"title", row.title}, {"description", row.description}};
  if (!row.unit.empty()) schema["x-unit"] = row.unit;
  schema.update(std::visit([](const auto& type) { return schema_of(type); }, row.type));
  return schema;
}

}  // namespace

Json options_schema() {
  Json properties;
  for (const OptionRow& row : option_table()) properties[std::string(row.name)] = schema_of(row);
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

}  // namespace fleetplan::api
