#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// A connected socket, closed at the end, with deadlines on everything that waits.
class Socket {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Read { some, end, timeout, stopped };

  /// `stop_fd`: once this descriptor becomes readable, reading ends at once and writing soon after.
  Socket(int fd, int stop_fd) : fd_(fd), stop_fd_(stop_fd) {}
  ~Socket();
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// Waits for input and appends it.
  Read read_some(std::string& into, Clock::time_point deadline);

  /// False when the peer is gone, accepts nothing for 10 s, or accepts less than 10 kB/s after the first
  /// 10 s.
  bool write_all(std::string_view data);

  /// True when the peer has closed its side.
  bool peer_gone() const;

  /// Ends the connection in both directions; peer_gone() is true from then on.
  void hang_up();

  /// True when there is input that was not read.
  bool has_input() const;

  /// Ends the sending side and discards input for a while, so that the last answer arrives: a close with
  /// unread input would reset the connection and could lose that answer.
  void linger();

  /// Address and port of the peer, e.g. 127.0.0.1:40310 or [::1]:40310; empty when it is gone.
  std::string peer() const;

  int fd() const { return fd_; }

 private:
  int fd_;
  int stop_fd_;
};

}  // namespace fleetplan::server
