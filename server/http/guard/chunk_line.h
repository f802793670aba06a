#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace fleetplan::server {

/// The line before a chunk of a body (RFC 9112, 7.1).
struct ChunkLine {
  std::uint64_t size;             // bytes of the chunk; 0: the last one
  std::uint64_t extension_bytes;  // of the line, after the size
};

/// `line`: without its CR LF. None unless it is a hexadecimal number of up to 16 digits, followed by nothing
/// but extensions `;name`, `;name=token` or `;name="text"`.
std::optional<ChunkLine> parse_chunk_line(std::string_view line);

}  // namespace fleetplan::server
