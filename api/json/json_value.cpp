#include "api/json/json_value.h"

#include <cmath>
#include <utility>

namespace fleetplan::api {

namespace {

// Beyond 2^53 doubles cannot distinguish neighbouring whole numbers.
constexpr double kLargestExactWhole = 9007199254740992.0;

}  // namespace

JsonValue::JsonValue() = default;
JsonValue::JsonValue(bool boolean) : data_(boolean) {}
JsonValue::JsonValue(std::int64_t number) : data_(number) {}
JsonValue::JsonValue(std::uint64_t number) : data_(number) {}
JsonValue::JsonValue(double number) : data_(number) {}
JsonValue::JsonValue(std::string string) : data_(std::make_unique<std::string>(std::move(string))) {}
JsonValue::JsonValue(Array items) : data_(std::make_unique<Array>(std::move(items))) {}
JsonValue::JsonValue(Object members) : data_(std::make_unique<Object>(std::move(members))) {}
JsonValue::JsonValue(JsonValue&& other) noexcept = default;
JsonValue& JsonValue::operator=(JsonValue&& other) noexcept = default;
JsonValue::~JsonValue() = default;

std::optional<double> JsonValue::number() const {
  if (const auto* real = std::get_if<double>(&data_)) return *real;
  if (const auto* natural = std::get_if<std::uint64_t>(&data_)) return static_cast<double>(*natural);
  if (const auto* integer = std::get_if<std::int64_t>(&data_)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::optional<std::uint64_t> JsonValue::natural() const {
  if (const auto* natural = std::get_if<std::uint64_t>(&data_)) return *natural;
  if (const auto* integer = std::get_if<std::int64_t>(&data_)) {
    if (*integer >= 0) return static_cast<std::uint64_t>(*integer);
  }
  if (const auto* real = std::get_if<double>(&data_)) {
    const bool whole = *real >= 0.0 && *real <= kLargestExactWhole && std::floor(*real) == *real;
    if (whole) return static_cast<std::uint64_t>(*real);
  }
  return std::nullopt;
}

const std::string* JsonValue::string() const {
  const auto* held = std::get_if<std::unique_ptr<std::string>>(&data_);
  return held != nullptr ? held->get() : nullptr;
}

const JsonValue::Array* JsonValue::array() const {
  const auto* held = std::get_if<std::unique_ptr<Array>>(&data_);
  return held != nullptr ? held->get() : nullptr;
}

const JsonValue::Object* JsonValue::object() const {
  const auto* held = std::get_if<std::unique_ptr<Object>>(&data_);
  return held != nullptr ? held->get() : nullptr;
}

const JsonValue* JsonValue::find(std::string_view key) const {
  const Object* members = object();
  if (members == nullptr) return nullptr;
  for (std::size_t index = 0; index < members->keys.size(); ++index) {
    if (members->keys[index] == key) return &members->values[index];
  }
  return nullptr;
}

}  // namespace fleetplan::api
