#include "api/request/shared_members.h"

#include <cmath>

#include "api/json/json_writer.h"

namespace fleetplan::api {

namespace {

/// Whether all numbers can be written as they were read. The depth of a document is limited.
bool is_finite(const JsonValue& value) {  // NOLINT(misc-no-recursion)
  if (const auto number = value.number()) return std::isfinite(*number);
  for (const JsonValue child : value.children()) {
    if (!is_finite(child)) return false;
  }
  return true;
}

}  // namespace

std::string parse_metadata(const JsonReader& owner) {
  const JsonReader member = owner.find("metadata");
  if (!member) return {};
  const JsonValue& value = member.value();
  if (!value.is_object()) {
    member.must_be(fault::kWrongType, "an object");
    return {};
  }
  if (!is_finite(value)) {
    member.fault(fault::kOutOfRange, "metadata has a number that is too large for a double.");
    return {};
  }
  JsonWriter json;
  copy_json(json, value);
  std::string text = json.take();
  if (text.size() <= kMostMetadataBytes) return text;
  member.fault(fault::kOutOfRange, "metadata has " + std::to_string(text.size()) +
                                       " bytes; this service accepts at most " +
                                       std::to_string(kMostMetadataBytes) + " in each object.");
  return {};
}

}  // namespace fleetplan::api
