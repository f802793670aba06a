#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// The trace_id, 32 hexadecimal digits, of a `traceparent` field (W3C Trace Context); none if the field is
/// absent (empty) or malformed.
std::optional<std::string> trace_id_of(std::string_view traceparent);

}  // namespace fleetplan::server
