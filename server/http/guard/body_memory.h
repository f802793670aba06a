#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace fleetplan::server {

/// Bounds what the bodies of all requests hold together, in bytes as sent and as decoded, so that many large
/// ones at the same time are refused. What is made of them, such as the parsed JSON, is not counted.
/// Thread-safe.
class BodyMemory {
 public:
  /// Enough for so many requests (at least one) with bodies of `max_body` bytes (up to 1 TiB), of which one
  /// is being decoded, beyond the small ones.
  BodyMemory(std::uint64_t max_body, std::size_t requests);

  /// What one request holds, until its end.
  class Share {
   public:
    explicit Share(BodyMemory& memory) : memory_(memory) {}
    ~Share() { memory_.left_ += held_; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// True when the request may hold so many bytes. Up to kSmall always: so many honest clients can be
    /// served beside a few that hoard the rest.
    bool grow_to(std::uint64_t bytes);

   private:
    BodyMemory& memory_;
    std::int64_t held_ = 0;
  };

  static constexpr std::uint64_t kSmall = 64 * 1024;
  /// What a client is told when there is no more.
  static constexpr const char* kFull = "Too many large requests are being received: try again later.";

 private:
  std::atomic<std::int64_t> left_;
};

}  // namespace fleetplan::server
