#pragma once

// Strict JSON: UTF-8, no NaN, no comments, nothing after the document, no key twice, bounded depth.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/faults.h"
#include "api/json/json_value.h"
#include "api/json/result.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// A document that is JSON, with the faults that only its reader can see (duplicate keys), and when to end
/// reading it. The text has to outlive it.
struct JsonDocument {
  JsonTape tape;
  FaultList faults;
  core::Work* work = nullptr;  // counts the work of reading the document

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

/// Reads a body. Arrays and objects may nest up to `max_depth` deep. Of two members with the same key the
/// first counts, and the later one is a fault. Uses no stack that grows with the body.
Result<JsonDocument, JsonError> read_json(std::string_view body, int max_depth, core::Work& work);

/// Returns the values of a text that is JSON. Reads them several times as fast as the general parser, which
/// megabytes of numbers or a large image need. Returns none if the text is not JSON, nests deeper than
/// `max_depth`, has more than `max_values` values or a number beyond the range of doubles or of 18 digits, or
/// if the stop is met. Then the general parser has the answer, and says what is wrong.
std::optional<JsonTape> parse_valid_json(std::string_view text, std::size_t max_depth, std::size_t max_values,
                                         core::Work& stop);

/// Returns how many bytes from the begin are characters of a JSON string as they are (RFC 8259, section 7):
/// valid UTF-8 without quotes, backslashes and control characters.
std::size_t plain_length(std::string_view text);

}  // namespace fleetplan::api
