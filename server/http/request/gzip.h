#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/runtime/stop_condition.h"
#include "server/http/request/body_reader.h"

namespace fleetplan::server {

/// Returns the text as one gzip member; none when the stop condition is met.
std::optional<std::string> gzip(std::string_view text, const core::StopCondition& stop);

/// Decodes a body of gzip members (RFC 1952, 2.2), which are one text together. Every member must be complete
/// with its checksum and length, and nothing else may follow. `limit`: the most decoded bytes. `share` holds
/// both forms of the body. Ends with a fault when the stop condition is met.
std::variant<std::string, BodyFault> gunzip(std::string_view coded, std::uint64_t limit,
                                            BodyMemory::Share& share, const core::StopCondition& stop);

}  // namespace fleetplan::server
