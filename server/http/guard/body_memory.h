#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace fleetplan::server {

/// Bounds the memory of the heads and bodies of all requests together, in bytes as sent and as decoded, so
/// that too many large ones at the same time are rejected. Small ones have a part of their own: other clients
/// are served even while a few occupy the rest. Memory for their content, such as parsed JSON, is not
/// counted. Thread-safe.
class BodyMemory {
 public:
  /// Enough for `requests` (at least one) bodies of `max_body` bytes (up to 1 TiB), of which one is being
  /// decoded, besides `small` ones of kSmall bytes.
  BodyMemory(std::uint64_t max_body, std::size_t requests, std::size_t small);

  /// The memory of one request, until its end.
  class Share {
   public:
    explicit Share(BodyMemory& memory) : memory_(memory) {}
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// True when the request may hold so many bytes.
    bool grow_to(std::uint64_t bytes);

   private:
    BodyMemory& memory_;
    std::int64_t held_ = 0;
    std::int64_t held_small_ = 0;
  };

  static constexpr std::uint64_t kSmall = 64 * 1024;
  /// The detail of the problem when there is no more.
  static constexpr const char* kFull = "Too many large requests are being received: try again later.";

 private:
  std::atomic<std::int64_t> left_;
  std::atomic<std::int64_t> small_left_;
};

}  // namespace fleetplan::server
