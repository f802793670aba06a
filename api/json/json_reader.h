#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "api/json/read_json.h"

namespace fleetplan::api {

/// A closed range of numbers, and their unit for messages.
struct Range {
  double least;
  double most;
  std::string_view unit;
};

/// An answer repeats names as often as robots conflict.
inline constexpr std::size_t kLongestName = 256;  // characters

/// A value of a document, or the absence of one, with typed access. What is wrong with the value becomes a
/// fault of the document, at the value's place; the read then returns nothing, as it does for an absent
/// value. A reader is a handle, copied freely; the document must outlive it and stay where it is.
class JsonReader {
 public:
  JsonReader() = default;  // absent
  /// The root of the document.
  explicit JsonReader(JsonDocument& document) : JsonReader(document, &document.root) {}

  explicit operator bool() const { return value_ != nullptr; }
  bool is_null() const { return value_ != nullptr && value_->is_null(); }
  bool is_number() const { return value_ != nullptr && value_->number().has_value(); }
  std::optional<std::uint64_t> natural() const;
  /// The text of a string; null when the value is something else, which is no fault.
  const std::string* string() const { return value_ != nullptr ? value_->string() : nullptr; }

  /// The value itself if it is an object, otherwise absent. Members that are not `known` are faults.
  JsonReader object(std::span<const std::string_view> known) const;
  /// A member of an object.
  JsonReader find(std::string_view key) const;
  /// A member that an object must have. `remedy` ends the fault's sentence: "; give ...".
  JsonReader require(std::string_view key, std::string_view remedy = {}) const;

  /// The value itself if it is an array, otherwise absent.
  JsonReader array() const;
  std::size_t size() const;  // of the array; 0 when absent
  JsonReader item(std::size_t index) const;

  std::optional<double> number(const Range& range) const;
  /// A whole number from 0 to `most`.
  std::optional<std::uint64_t> natural(std::uint64_t most) const;
  std::optional<bool> boolean() const;
  /// A string of 1 to kLongestName characters.
  std::optional<std::string> name() const;
  /// The index of the word that the string is.
  std::optional<std::size_t> word(std::span<const std::string_view> words) const;

  /// The value, which must be there, for a message: `the string "abc"`, `-1`, `an array`.
  std::string description() const;
  /// Adds a fault at the value, which must be there.
  void fault(const char* code, const std::string& detail) const;
  /// The same with the detail "<name> must be <wanted>, not <value><note>."
  void must_be(const char* code, std::string_view wanted, std::string_view note = {}) const;
  /// Faults of the document so far.
  std::size_t fault_count() const { return document_ != nullptr ? document_->faults.count() : 0; }

 private:
  JsonReader(JsonDocument& document, const JsonValue* value) : document_(&document), value_(value) {}
  JsonReader at(const JsonValue* value) const {
    return value != nullptr ? JsonReader(*document_, value) : JsonReader();
  }
  void wrong_type(std::string_view wanted) const;

  JsonDocument* document_ = nullptr;
  const JsonValue* value_ = nullptr;  // in the document; null: absent
};

}  // namespace fleetplan::api
