#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "server/http/guard/body_memory.h"
#include "server/http/guard/request_head.h"
#include "server/http/guard/socket.h"

namespace fleetplan::server {

/// Why there is no body.
struct BodyFault {
  enum class Kind { malformed, too_large, no_room, too_slow, stopped };
  Kind kind;
  std::string detail;
};

/// Reads the body of a request as it was sent, still content-coded, by Content-Length or chunked. Rejects
/// malformed framing; chunk extensions and trailers are read and dropped.
///
/// `input` holds what was read beyond the head; what follows the body stays in it. `limit`: bytes of body.
/// `share`: of the memory of all bodies, to hold this one. `patience`: the longest pause of the client, and
/// how far it may fall behind 100 kB/s in all.
std::variant<std::string, BodyFault> read_body(Socket& socket, std::string& input, const RequestHead& head,
                                               std::uint64_t limit, BodyMemory::Share& share,
                                               std::chrono::milliseconds patience);

}  // namespace fleetplan::server
