#pragma once

// Strict JSON: UTF-8, no NaN, no comments, nothing after the document, no key twice, bounded depth.

#include <string>
#include <string_view>
#include <variant>

#include "api/json/fault_list.h"
#include "api/json/json_value.h"
#include "api/response/error.h"

namespace fleetplan::api {

/// A document that is JSON, with the faults that only its reader can see (keys that come twice).
struct JsonDocument {
  JsonValue root;
  FaultList faults;
};

/// Why a body is not a document: malformed_json, with line, column and byte, or too_deep.
struct JsonError {
  ErrorCode code = ErrorCode::malformed_json;
  std::string detail;
};

/// Reads a body; arrays and objects may nest up to `max_depth` deep. Of two members with the same key the
/// first counts, and the later is a fault. Uses no stack that grows with the body.
std::variant<JsonDocument, JsonError> read_json(std::string_view body, int max_depth);

}  // namespace fleetplan::api
