#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/json/read_value.h"

namespace fleetplan::api {

/// Reads the members of one object. That it is one, and has no other members than those known, is checked
/// first. Refers to its arguments, which must live longer.
class ObjectReader {
 public:
  ObjectReader(const JsonValue& value, const JsonPath& path, std::span<const std::string_view> known,
               FaultList& faults);

  bool is_object() const { return value_.object() != nullptr; }
  JsonPath path(std::string_view key) const { return path_ / key; }
  /// The member, or null.
  const JsonValue* find(std::string_view key) const { return value_.find(key); }
  /// The member; null and a fault when it is missing. `remedy` ends the fault's sentence: "; give ...".
  const JsonValue* require(std::string_view key, std::string_view remedy = {}) const;

  /// A number that has to be there.
  std::optional<double> require_number(std::string_view key, const Range& range) const;
  /// A number, or what stands in for it when it is left out or wrong.
  double number_or(std::string_view key, const Range& range, double otherwise) const;

 private:
  const JsonValue& value_;
  const JsonPath& path_;
  FaultList& faults_;
};

}  // namespace fleetplan::api
