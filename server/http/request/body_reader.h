#pragma once

// The body of a request as it arrives: the memory it may take, its chunks, and the reader of both.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "server/http/request/request_head.h"

namespace fleetplan::server {

/// Bounds the memory of the heads and bodies of all requests together, in bytes as sent and as decoded. So
/// too many large bodies at the same time are rejected. Small bodies have a separate part: other clients are
/// served even while a few occupy the rest. Memory for their content, such as parsed JSON, is not counted.
/// Thread-safe.
class BodyMemory {
 public:
  /// Has memory for `requests` (at least one) bodies of `max_body` bytes (up to 1 TiB), and for `small`
  /// bodies of kSmall bytes. One of the large bodies may be decoded at the same time.
  BodyMemory(std::uint64_t max_body, std::size_t requests, std::size_t small);

  /// The memory that one request holds until its end.
  class Share {
   public:
    explicit Share(BodyMemory& memory) : memory_(memory) {}
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Reserves memory for so many bytes. Returns whether the request may hold them.
    bool grow_to(std::uint64_t bytes);

   private:
    BodyMemory& memory_;
    std::int64_t held_ = 0;
    std::int64_t held_small_ = 0;
  };

  static constexpr std::uint64_t kSmall = 64 * 1024;
  /// The detail of the problem when there is no more memory.
  static constexpr const char* kFull = "Too many large requests are being received: try again later.";

 private:
  std::atomic<std::int64_t> left_;
  std::atomic<std::int64_t> small_left_;
};

/// The line before a chunk of a body (RFC 9112, 7.1).
struct ChunkLine {
  std::uint64_t size;             // bytes of the chunk; 0: the last one
  std::uint64_t extension_bytes;  // bytes of the line after the size
};

/// Parses the line before a chunk, without its CR LF. The line must be a hexadecimal number of up to 16
/// digits. Only extensions `;name`, `;name=token` or `;name="text"` may follow. Returns none otherwise.
std::optional<ChunkLine> parse_chunk_line(std::string_view line);

/// Why there is no body.
struct BodyFault {
  enum class Kind { malformed, too_large, no_room, too_slow, stopped };
  Kind kind;
  std::string detail;
};

api::ErrorCode code_of(BodyFault::Kind kind);
BodyFault malformed_body(std::string detail);
BodyFault too_large_body(const std::string& size, std::uint64_t limit);

/// Reads the body of a request as it was sent, still content-coded, as its bytes arrive. Its length is given
/// by Content-Length or chunks (RFC 9112, 6 and 7). Rejects malformed framing. Chunk extensions and trailers
/// are checked and dropped.
class BodyReader {
 public:
  enum class State { incomplete, complete, failed };

  /// Reads a body of at most `limit` bytes. `share` of the memory of all bodies holds it. Null: the body is
  /// dropped instead.
  BodyReader(const RequestHead& head, std::uint64_t limit, BodyMemory::Share* share);

  /// Removes the part of the body that has arrived from `input`. What follows the body stays there.
  State take(std::string& input);

  /// The body, once it is complete.
  std::string&& take_body() { return std::move(body_); }

  /// The number of bytes of the body so far.
  std::uint64_t size() const { return size_; }

  /// The fault, once reading has failed.
  const BodyFault& fault() const { return fault_; }

 private:
  enum class Part { data, data_end, size_line, trailers, end };

  // In the functions below, `complete` refers to the part, see part_.
  State fail(BodyFault fault);
  State take_parts(std::string_view input);
  State take_data(std::string_view input);
  State take_line(std::string_view input);
  State begin_chunk(std::string_view line);
  State take_trailer(std::string_view line);

  const bool chunked_;
  const std::uint64_t limit_;
  BodyMemory::Share* const share_;
  Part part_;
  std::uint64_t left_ = 0;  // bytes left of the chunk, or of the body that is not chunked
  std::uint64_t size_ = 0;  // bytes of the body so far
  std::uint64_t extensions_ = 0;
  std::size_t trailers_ = 0;
  std::size_t taken_ = 0;  // bytes taken of the input
  std::string body_;
  BodyFault fault_{};
};

}  // namespace fleetplan::server
