#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "server/http/guard/body_memory.h"
#include "server/http/guard/body_reader.h"

namespace fleetplan::server {

/// Decodes a body of gzip members (RFC 1952, 2.2), which are one text together. Every member must be complete
/// with its checksum and length, and nothing else may follow. `limit`: decoded bytes. `share`: holds both
/// forms of the body.
std::variant<std::string, BodyFault> gunzip(std::string_view coded, std::uint64_t limit,
                                            BodyMemory::Share& share);

}  // namespace fleetplan::server
