#pragma once

// A JSON document in memory. Every value knows its place in the document, so that faults can be located and
// reported in the order of the document.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fleetplan::api {

/// One JSON value. Numbers keep their 64-bit integers exactly; a number too large for a double is infinite.
class JsonValue {
 public:
  using Array = std::vector<JsonValue>;
  struct Object;  // members in the order of the document

  JsonValue();
  explicit JsonValue(bool boolean);
  explicit JsonValue(std::int64_t number);
  explicit JsonValue(std::uint64_t number);
  explicit JsonValue(double number);
  explicit JsonValue(std::string string);
  explicit JsonValue(Array items);
  explicit JsonValue(Object members);
  JsonValue(JsonValue&& other) noexcept;
  JsonValue& operator=(JsonValue&& other) noexcept;
  ~JsonValue();

  bool is_null() const { return std::holds_alternative<std::monostate>(data_); }
  const bool* boolean() const { return std::get_if<bool>(&data_); }
  /// Any number as a double; infinite when it was too large for one.
  std::optional<double> number() const;
  /// A number that is a whole one from 0 to 2^64 - 1 (also when written like 5.0).
  std::optional<std::uint64_t> natural() const;
  /// The string, array or object, or null when the value is something else.
  const std::string* string() const;
  const Array* array() const;
  const Object* object() const;
  /// The first member of that name of an object, or null.
  const JsonValue* find(std::string_view key) const;

  /// Where the value begins and ends in the document: comparable with each other, otherwise meaningless.
  std::uint32_t begins() const { return begins_; }
  std::uint32_t ends() const { return ends_; }
  void set_place(std::uint32_t begins, std::uint32_t ends) {
    begins_ = begins;
    ends_ = ends;
  }

 private:
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::unique_ptr<std::string>,
               std::unique_ptr<Array>, std::unique_ptr<Object>>
      data_;
  std::uint32_t begins_ = 0;
  std::uint32_t ends_ = 0;
};

struct JsonValue::Object {
  std::vector<std::string> keys;
  std::vector<JsonValue> values;  // as many as keys
};

}  // namespace fleetplan::api
