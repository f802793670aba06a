#include "api/json/object_reader.h"

#include <algorithm>
#include <string>

#include "api/json/text.h"

namespace fleetplan::api {

ObjectReader::ObjectReader(const JsonValue& value, const JsonPath& path,
                           std::span<const std::string_view> known, FaultList& faults)
    : value_(value), path_(path), faults_(faults) {
  const JsonValue::Object* object = value.object();
  if (object == nullptr) {
    faults.add(value, path, fault::kWrongType,
               path.name() + " must be an object, not " + described(value) + ".");
    return;
  }
  for (std::size_t index = 0; index < object->keys.size(); ++index) {
    const std::string& key = object->keys[index];
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string meant = suggestion(key, known);
    faults.add(object->values[index], path / key, fault::kUnknownKey,
               in_quotes(key) + " is not known here" +
                   (meant.empty() ? "; what is: " + alternatives(known) + "." : meant));
  }
}

const JsonValue* ObjectReader::require(std::string_view key, std::string_view remedy) const {
  const JsonValue* member = value_.find(key);
  if (member == nullptr && is_object()) {
    faults_.add_missing(value_, path(key), std::string(key) + " is missing" + std::string(remedy) + ".");
  }
  return member;
}

std::optional<double> ObjectReader::require_number(std::string_view key, const Range& range) const {
  const JsonValue* member = require(key);
  if (member == nullptr) return std::nullopt;
  return read_number(*member, path(key), range, faults_);
}

double ObjectReader::number_or(std::string_view key, const Range& range, double otherwise) const {
  const JsonValue* member = find(key);
  if (member == nullptr) return otherwise;
  return read_number(*member, path(key), range, faults_).value_or(otherwise);
}

}  // namespace fleetplan::api
