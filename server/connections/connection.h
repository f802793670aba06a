#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <optional>
#include <string>
#include <system_error>

#include "server/connections/steps.h"
#include "server/http/answer/direct_answers.h"
#include "server/http/answer/unsent_answers.h"
#include "server/http/exchange.h"
#include "server/http/request/body_reader.h"
#include "server/ops/settings.h"

namespace fleetplan::server {

/// A flag that threads can wait for in poll(): its descriptor stays readable once it is raised.
class StopSignal {
 public:
  StopSignal() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  ~StopSignal() { ::close(fd_); }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  void raise() {
    raised_ = true;
    ::eventfd_write(fd_, 1);
  }
  bool raised() const { return raised_; }
  int fd() const { return fd_; }

 private:
  int fd_;
  std::atomic<bool> raised_{false};
};

/// The objects that all connections of a port share.
struct ConnectionContext {
  const Settings& settings;
  const Steps& steps;
  BodyMemory& body_memory;
  UnsentAnswers& unsent_answers;
  const std::atomic<bool>& draining;
  std::atomic<std::size_t>& exchanges;  // number of exchanges under way
  const StopSignal& stop;
  std::function<Sent(Exchange&)> answer;  // answers a request that passed all steps
};

/// Counts something as under way during its lifetime.
class UnderWay {
 public:
  explicit UnderWay(std::atomic<std::size_t>& count) : count_(count) { ++count_; }
  ~UnderWay() { --count_; }
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

 private:
  std::atomic<std::size_t>& count_;
};

/// One client's connection. It reads its requests strictly and takes each through the steps. It sends the
/// answers that need no handler itself.
///
/// It never waits for the client. Where it would have to wait, it returns, and goes on once there is
/// something to do. So a client that is idle or slow, in either direction, occupies no thread.
class Connection {
 public:
  using Clock = Socket::Clock;

  /// What has to happen before a connection can go on.
  struct Wait {
    bool for_input;              // it waits for input, otherwise for room to send
    Clock::time_point deadline;  // goes on at this time, whatever has happened
    Clock::time_point since;     // begin of the client's turn
    bool stopped;                // the stop signal has been seen; until then, it goes on with the signal, too
  };

  /// Takes the socket over.
  Connection(int fd, ConnectionContext context);

  /// Goes on until it has to wait, and returns what it waits for. Returns none if it is over: the client left
  /// or was idle for too long, or the server stops. Call it from one thread at a time.
  std::optional<Wait> go_on();

  /// Returns the last result of go_on(). Before the first call, returns what has to happen first.
  Wait wait() const;

  int fd() const { return socket_.fd(); }

 private:
  enum class Phase { idle, head, body, sending, dropping, lingering, over };
  enum class Input { some, nothing, end, timeout, stopped };

  // The functions below continue their phase. They return true to go on with the next phase, false to wait.
  bool idle();
  bool head();
  bool body();
  bool sending();
  bool dropping();
  bool lingering();

  void begin(Phase phase, Clock::time_point deadline);
  void begin_exchange();
  void judge_head(HeadScanner::State state);
  void begin_body();
  void set_body_deadline();
  void end_body();
  void refuse(api::ErrorCode code, const std::string& detail);
  void refuse(const BodyFault& fault);
  void answer_directly(const DirectAnswer& answer);
  void answer();
  void send_rest(const Sent& sent);
  void end_exchange();
  Input receive();

  ConnectionContext context_;
  Socket socket_;
  const std::string peer_;
  std::string input_;  // input that was read and is not used yet
  Phase phase_ = Phase::idle;
  Clock::time_point since_;     // begin of the phase
  Clock::time_point deadline_;  // end of the phase
  bool stop_seen_ = false;
  bool unread_ = false;  // the client may still be sending

  std::optional<Exchange> exchange_;  // from the first byte of a request to the last one of its answer
  std::optional<UnderWay> under_way_;
  HeadScanner scanner_;
  std::size_t empty_line_bytes_ = 0;  // bytes of empty lines before the request
  std::optional<BodyReader> body_;    // body of the exchange; later the body of a refused exchange, to be
                                      // dropped
  std::uint64_t body_bytes_ = 0;      // bytes of the body when the deadline was set
  Sent sent_;
  std::optional<WritePatience> write_patience_;
};

}  // namespace fleetplan::server
