#pragma once

// Strict JSON: UTF-8, no NaN, no comments, nothing after the document, no key twice, bounded depth.

#include <string>
#include <string_view>

#include "api/json/fault_list.h"
#include "api/json/json_value.h"
#include "api/json/result.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// A document that is JSON, with the faults that only its reader can see (duplicate keys), and when to end
/// reading it. The text has to outlive it.
struct JsonDocument {
  JsonTape tape;
  FaultList faults;
  core::Work* work = nullptr;  // that is done when the document is read

  JsonValue root() const { return tape.root(); }
};

/// Why a body is not a document that can be read.
struct JsonError {
  enum class Kind {
    malformed,  // the detail has line, column and byte
    too_deep,
    too_large,   // more values than any request needs
    unfinished,  // the stop was met first; no detail
  };
  Kind kind = Kind::malformed;
  std::string detail;
};

/// Reads a body; arrays and objects may nest up to `max_depth` deep. Of two members with the same key the
/// first counts, and the later is a fault. Uses no stack that grows with the body.
Result<JsonDocument, JsonError> read_json(std::string_view body, int max_depth, core::Work& work);

}  // namespace fleetplan::api
