#pragma once

#include <string>
#include <string_view>

#include "api/json/json_value.h"

namespace fleetplan::api {

/// Where a value stands in its document.
struct Location {
  std::string pointer;  // RFC 6901: "" for the whole document, "/robots/0/start" below it
  std::string name;     // of the last step, for messages: the key, "item 3" or "the document"
};

/// Finds a value of the document with this root, by its place in it.
Location locate(const JsonValue& root, const JsonValue& value);

/// One step of a JSON Pointer: "/" and the key, with ~ and / escaped.
std::string pointer_step(std::string_view key);

}  // namespace fleetplan::api
