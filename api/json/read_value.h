#pragma once

// Single values of a document: of the right type and in their range, or a fault.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/json/text.h"

namespace fleetplan::api {

/// A closed range of numbers, and their unit for people.
struct Range {
  double least;
  double most;
  std::string_view unit;
};

// Lengths, speeds and coordinates beyond a million kilometres or below an atom are mistakes; with these
// bounds no computation of the core overflows.
inline constexpr double kSmallest = 1e-9;
inline constexpr double kLargest = 1e9;
inline constexpr Range kLength{kSmallest, kLargest, "metres"};
inline constexpr Range kLengthOrZero{0.0, kLargest, "metres"};
inline constexpr Range kCoordinate{-kLargest, kLargest, "metres"};
inline constexpr Range kDuration{0.0, kLargest, "seconds"};
inline constexpr Range kAnyAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "radians"};

/// The number, if it is one and in the range.
std::optional<double> read_number(const JsonValue& value, const JsonPath& path, const Range& range,
                                  FaultList& faults);

/// The whole number from 0 to `most`.
std::optional<std::uint64_t> read_natural(const JsonValue& value, const JsonPath& path, std::uint64_t most,
                                          FaultList& faults);

std::optional<bool> read_boolean(const JsonValue& value, const JsonPath& path, FaultList& faults);

/// An answer repeats names as often as robots are in each other's way.
inline constexpr std::size_t kLongestName = 256;  // characters

/// The string, which has 1 to kLongestName characters.
std::optional<std::string> read_name(const JsonValue& value, const JsonPath& path, FaultList& faults);

/// The items of an array.
const JsonValue::Array* read_array(const JsonValue& value, const JsonPath& path, FaultList& faults);

/// Which of the words the string is.
std::optional<std::size_t> read_word(const JsonValue& value, const JsonPath& path,
                                     std::span<const std::string_view> words, FaultList& faults);

/// What the string stands for.
template <typename Choice, std::size_t kCount>
std::optional<Choice> read_choice(const JsonValue& value, const JsonPath& path,
                                  const std::pair<std::string_view, Choice> (&choices)[kCount],
                                  FaultList& faults) {
  std::vector<std::string_view> words;
  words.reserve(kCount);
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto index = read_word(value, path, words, faults);
  if (!index) return std::nullopt;
  return choices[*index].second;
}

}  // namespace fleetplan::api
