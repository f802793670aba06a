#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/json_value.h"

namespace fleetplan::api {

template <typename T>
concept WholeNumber = std::integral<T> && !std::same_as<T, bool>;

/// Writes JSON text from front to back, without a tree in memory, and adds the commas. A number has the
/// shortest text that reads back the same, never -0.0. Non-finite numbers become null. Invalid UTF-8 in
/// strings becomes U+FFFD.
class JsonWriter {
 public:
  JsonWriter& begin_object();
  JsonWriter& end_object();
  JsonWriter& begin_array();
  JsonWriter& end_array();
  JsonWriter& key(std::string_view name);

  JsonWriter& value(double number);
  JsonWriter& value(const std::optional<double>& number);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  template <std::same_as<bool> Boolean>
  JsonWriter& value(Boolean boolean) {
    return raw(boolean ? "true" : "false");
  }
  template <WholeNumber Integer>
  JsonWriter& value(Integer number) {
    return raw(std::to_string(number));
  }

  /// Writes a value that is JSON text.
  JsonWriter& json(std::string_view text) { return raw(text); }
  /// Writes a member: its key and its value.
  template <typename Value>
  JsonWriter& member(std::string_view name, const Value& held) {
    return key(name).value(held);
  }

  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  /// Returns the text so far, and leaves the writer empty.
  std::string take() { return std::move(text_); }

 private:
  JsonWriter& raw(std::string_view text);
  void separate();
  void append_string(std::string_view text);

  std::string text_;
};

/// Writes a value of a document with everything in it. Numbers keep their values; whole numbers up to 2^64 -
/// 1 exactly.
void copy_json(JsonWriter& json, const JsonValue& value);

/// Writes a value of a document without `null`: members and items that are null are left out.
void copy_without_null(JsonWriter& json, const JsonValue& value);

}  // namespace fleetplan::api
