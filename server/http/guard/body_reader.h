#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/error.h"
#include "server/http/guard/body_memory.h"
#include "server/http/guard/request_head.h"

namespace fleetplan::server {

/// Why there is no body.
struct BodyFault {
  enum class Kind { malformed, too_large, no_room, too_slow, stopped };
  Kind kind;
  std::string detail;
};

api::ErrorCode code_of(BodyFault::Kind kind);
BodyFault malformed_body(std::string detail);
BodyFault too_large_body(const std::string& size, std::uint64_t limit);

/// Reads the body of a request as it was sent, still content-coded, by Content-Length or chunked (RFC 9112,
/// 6 and 7), as its bytes arrive. Rejects malformed framing; chunk extensions and trailers are checked and
/// dropped.
class BodyReader {
 public:
  enum class State { incomplete, complete, failed };

  /// `limit`: bytes of body. `share`: of the memory of all bodies, to hold this one; null: the body is
  /// dropped instead.
  BodyReader(const RequestHead& head, std::uint64_t limit, BodyMemory::Share* share);

  /// Takes what has arrived off `input`; what follows the body stays there.
  State take(std::string& input);

  /// Once complete.
  std::string&& take_body() { return std::move(body_); }

  /// Bytes of the body so far.
  std::uint64_t size() const { return size_; }

  /// Once failed.
  const BodyFault& fault() const { return fault_; }

 private:
  enum class Part { data, data_end, size_line, trailers, end };

  // `complete` means the part, see part_.
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
  std::uint64_t left_ = 0;  // of the chunk, or of the body that is not chunked
  std::uint64_t size_ = 0;  // of the body so far
  std::uint64_t extensions_ = 0;
  std::size_t trailers_ = 0;
  std::size_t taken_ = 0;  // of the input
  std::string body_;
  BodyFault fault_{};
};

}  // namespace fleetplan::server
