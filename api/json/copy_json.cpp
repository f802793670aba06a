#include "api/json/copy_json.h"

namespace fleetplan::api {

// The depth of a document is limited when it is read.
void copy_json(JsonWriter& json, const JsonValue& value) {  // NOLINT(misc-no-recursion)
  if (value.is_object()) {
    json.begin_object();
    for (const JsonValue member : value.children()) {
      json.key(member.key());
      copy_json(json, member);
    }
    json.end_object();
  } else if (value.is_array()) {
    json.begin_array();
    for (const JsonValue item : value.children()) copy_json(json, item);
    json.end_array();
  } else if (const auto text = value.string()) {
    json.value(*text);
  } else if (const auto natural = value.natural()) {
    json.value(*natural);
  } else if (const auto integer = value.integer()) {
    json.value(*integer);
  } else if (const auto boolean = value.boolean()) {
    json.value(*boolean);
  } else {
    json.value(value.number());  // null for none
  }
}

}  // namespace fleetplan::api
