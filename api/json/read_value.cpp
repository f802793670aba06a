#include "api/json/read_value.h"

#include <algorithm>
#include <cmath>

namespace fleetplan::api {

namespace {

void wrong_type(const JsonValue& value, const JsonPath& path, const char* wanted, FaultList& faults) {
  std::string detail = path.name() + " must be " + wanted + ", not " + described(value);
  if (value.is_null()) detail += "; leave it out for its default, where it has one";
  faults.add(value, path, fault::kWrongType, detail + ".");
}

std::string range_text(const Range& range) {
  const std::string unit(range.unit);
  if (range.least == kAnyAngle.least) return "finite, in " + unit;
  if (range.most == kAnyAngle.most) return "at least " + number_text(range.least) + ' ' + unit;
  return "from " + number_text(range.least) + " to " + number_text(range.most) + ' ' + unit;
}

/// Of UTF-8: all bytes but those that go on with a character.
std::size_t characters_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

std::optional<double> read_number(const JsonValue& value, const JsonPath& path, const Range& range,
                                  FaultList& faults) {
  const auto number = value.number();
  if (!number) {
    wrong_type(value, path, "a number", faults);
    return std::nullopt;
  }
  if (std::isfinite(*number) && *number >= range.least && *number <= range.most) return number;
  faults.add(value, path, fault::kOutOfRange,
             path.name() + " must be " + range_text(range) + ", not " + described(value) + ".");
  return std::nullopt;
}

std::optional<std::uint64_t> read_natural(const JsonValue& value, const JsonPath& path, std::uint64_t most,
                                          FaultList& faults) {
  const auto number = value.number();
  const auto natural = value.natural();
  if (natural && *natural <= most) return natural;
  const std::string wanted = "a whole number from 0 to " + std::to_string(most);
  const bool fraction = number && std::isfinite(*number) && std::floor(*number) != *number;
  if (!number || fraction) {
    wrong_type(value, path, wanted.c_str(), faults);
  } else {
    faults.add(value, path, fault::kOutOfRange,
               path.name() + " must be " + wanted + ", not " + described(value) + ".");
  }
  return std::nullopt;
}

std::optional<bool> read_boolean(const JsonValue& value, const JsonPath& path, FaultList& faults) {
  if (const bool* boolean = value.boolean()) return *boolean;
  wrong_type(value, path, "true or false", faults);
  return std::nullopt;
}

std::optional<std::string> read_name(const JsonValue& value, const JsonPath& path, FaultList& faults) {
  const std::string* name = value.string();
  if (name == nullptr) {
    wrong_type(value, path, "a string", faults);
    return std::nullopt;
  }
  const std::size_t length = characters_of(*name);
  if (length > 0 && length <= kLongestName) return *name;
  if (length == 0) {
    faults.add(value, path, fault::kEmpty, path.name() + " must not be empty.");
  } else {
    faults.add(value, path, fault::kOutOfRange,
               path.name() + " must have at most " + std::to_string(kLongestName) + " characters, not " +
                   std::to_string(length) + ".");
  }
  return std::nullopt;
}

const JsonValue::Array* read_array(const JsonValue& value, const JsonPath& path, FaultList& faults) {
  if (value.array() == nullptr) wrong_type(value, path, "an array", faults);
  return value.array();
}

std::optional<std::size_t> read_word(const JsonValue& value, const JsonPath& path,
                                     std::span<const std::string_view> words, FaultList& faults) {
  const std::string wanted = alternatives(words);
  const std::string* word = value.string();
  if (word == nullptr) {
    wrong_type(value, path, wanted.c_str(), faults);
    return std::nullopt;
  }
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::string meant = suggestion(*word, words);
  faults.add(
      value, path, fault::kUnknownValue,
      path.name() + " must be " + wanted + ", not " + in_quotes(*word) + (meant.empty() ? "." : meant));
  return std::nullopt;
}

}  // namespace fleetplan::api
