#pragma once

#include <cstdint>
#include <optional>

#include "api/response/reply.h"
#include "server/http/exchange.h"
#include "server/http/library/http_library.h"

namespace fleetplan::server {

/// Replaces the body of an exchange that is gzip-coded by what the library decodes it to, at most `limit`
/// bytes. The problem to reply with if that fails.
std::optional<api::Reply> decode_body(Exchange& exchange, const httplib::ContentReader& reader,
                                      std::uint64_t limit);

}  // namespace fleetplan::server
