#pragma once

#include "api/json/read_json.h"

namespace fleetplan::api {

/// Reports every member whose key an earlier member of the same object has; until the document's stop is met.
/// Takes n log n time for n members, whatever their keys.
void report_duplicate_keys(JsonDocument& document);

}  // namespace fleetplan::api
