#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// A connected socket, closed at the end. Neither reading nor writing waits.
class Socket {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Read { some, nothing, end };

  explicit Socket(int fd) : fd_(fd) {}
  ~Socket();
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// Appends input that has arrived.
  Read read_some(std::string& into);

  /// Sends as much as the peer takes at once. Returns the number of bytes; none if the peer is gone.
  std::optional<std::size_t> write_some(std::string_view data);

  /// Whether the peer has closed its side.
  bool peer_gone() const;

  /// Ends the connection in both directions. From then on, peer_gone() is true.
  void hang_up();

  /// Ends the sending side.
  void end_sending();

  /// Whether there is input that was not read.
  bool has_input() const;

  /// Returns address and port of the peer, e.g. 127.0.0.1:40310 or [::1]:40310. Empty if the peer is gone.
  std::string peer() const;

  int fd() const { return fd_; }

 private:
  int fd_;
};

/// How long a peer may take to accept data: it may pause for 10 s, and fall behind 10 kB/s by 10 s in all.
class WritePatience {
 public:
  /// Begins now, for so many bytes.
  explicit WritePatience(std::size_t size);

  /// Limits the patience when the service ends: 2 s are left.
  void stop();
  bool stopped() const { return stopped_; }

  /// Returns the deadline of the next bytes, if some have just been accepted.
  Socket::Clock::time_point deadline() const;

 private:
  Socket::Clock::time_point whole_;
  bool stopped_ = false;
};

}  // namespace fleetplan::server
