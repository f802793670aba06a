#pragma once

#include "api/json/json_value.h"
#include "api/json/json_writer.h"

namespace fleetplan::api {

/// Writes a value of a document with all that is in it. Numbers keep their values, whole ones up to 2^64 - 1
/// exactly.
void copy_json(JsonWriter& json, const JsonValue& value);

}  // namespace fleetplan::api
