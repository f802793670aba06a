#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/socket.h"

namespace fleetplan::server {

/// Bounds the memory of answers that clients have not accepted yet, of all connections together. If an answer
/// has no room, others are dropped, first the answer whose client has accepted nothing for the longest time.
/// The newest answer is kept whatever its size. Thread-safe.
class UnsentAnswers {
 public:
  class Answer;

  /// Keeps at most `max_bytes` of all answers together. If the newest answer is larger, it is kept alone.
  explicit UnsentAnswers(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  struct Stats {
    std::size_t bytes = 0;      // bytes held now
    std::uint64_t dropped = 0;  // answers dropped since the start
  };
  Stats stats() const;

 private:
  void keep(Answer& answer, std::string_view rest);
  void accepted(Answer& answer);
  void forget(Answer& answer);
  void forget_locked(Answer& answer);
  void make_room(std::size_t bytes, const Answer& newest);

  const std::size_t max_bytes_;
  mutable std::mutex mutex_;  // guards all below; locked before an answer's mutex
  Stats stats_;
  std::vector<Answer*> held_;
};

/// The data that a connection has to send. A dropped answer ends its connection. Used by one thread at a
/// time.
class UnsentAnswers::Answer {
 public:
  Answer(UnsentAnswers& all, Socket& socket) : all_(all), socket_(socket) {}
  ~Answer() { all_.forget(*this); }
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  /// Sends what the client accepts at once, and keeps the rest. Returns false if the client is gone, or if
  /// the rest was dropped.
  bool send(std::string_view data);

  /// Sends more of the rest. Returns the number of bytes; none if the client is gone, or if the rest was
  /// dropped.
  std::optional<std::size_t> send_rest();

  /// Whether a part was not accepted yet. A dropped rest counts.
  bool has_rest() const;

  /// The number of bytes that are left.
  std::size_t rest() const;

 private:
  friend class UnsentAnswers;
  using Clock = Socket::Clock;

  UnsentAnswers& all_;
  Socket& socket_;
  // The members below are guarded by the mutex of `all_`.
  bool is_held_ = false;
  std::size_t counted_ = 0;  // bytes
  Clock::time_point accepted_at_ = {};

  mutable std::mutex mutex_;  // guards all below
  std::string text_;
  std::size_t sent_ = 0;  // bytes of the text that are sent
  bool dropped_ = false;
};

}  // namespace fleetplan::server
