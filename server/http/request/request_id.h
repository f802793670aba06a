#pragma once

// The ids by which a request is found in logs: its own, and that of the trace it belongs to.

#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// Whether an id has 1..128 characters of [A-Za-z0-9._-]: safe in a header, a log line and a file name.
bool is_well_formed_request_id(std::string_view id);

/// Returns 128 random bits as 32 hexadecimal digits.
std::string make_request_id();

/// Returns the trace_id, 32 hexadecimal digits, of a `traceparent` field (W3C Trace Context); none if the
/// field is absent (empty) or malformed.
std::optional<std::string> trace_id_of(std::string_view traceparent);

}  // namespace fleetplan::server
