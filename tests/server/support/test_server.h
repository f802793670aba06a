#pragma once

// A server on a free port of its own with a stub service, and connections to it.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http/cpp_httplib.h"
#include "server/http_server.h"

namespace fleetplan::server {

/// Jobs wait here until the test opens it, or until their stop is requested.
class Gate {
 public:
  /// For a job: returns true once open, false when stopped before.
  bool pass(const std::stop_token& stop);
  void open();
  void await_waiting(int jobs);

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool open_ = false;
  int waiting_ = 0;
};

/// Echoes the body's size and reports what its context was. A body that begins with "gate" waits at
/// the gate, "throw" throws, "no memory" as where the process has none.
class StubService {
 public:
  Service service();

  Gate gate;
  std::atomic<int> stopped{0};  // jobs that saw a request to stop

 private:
  api::Reply answer(std::string_view body, const api::RequestContext& context);
};

/// Waits for the turn of a request without a deadline; false when it is refused or stopped.
bool has_turn(const api::RequestContext& context);

class TestServer {
 public:
  /// Port and log level of `settings` are ignored.
  explicit TestServer(Settings settings = {});
  /// With another service than the stub.
  TestServer(Settings settings, Service service);
  ~TestServer();
  TestServer(const TestServer&) = delete;
  TestServer& operator=(const TestServer&) = delete;

  void stop();

  /// A client with a connection of its own, kept alive.
  httplib::Client client() const;

  StubService stub;
  HttpServer server;

 private:
  void start();

  std::thread thread_;
};

/// All values of a header field, in their order.
std::vector<std::string> values_of(const httplib::Result& answer, const std::string& field);

/// A plain TCP connection to 127.0.0.1, for bytes that no HTTP client sends.
class RawConnection {
 public:
  explicit RawConnection(int port);
  ~RawConnection();
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  void send(const std::string& text) const;

  /// Closes this side, half of the connection.
  void end_of_sending() const;

  /// Reads an answer with its Content-Length; empty when the server closes instead.
  std::string receive();

  /// Reads to the end of this text, which is part of the result; empty when the server closes before.
  std::string receive_past(const std::string& text);

  /// Reads until the server closes.
  std::string receive_all();

  /// True when the server has closed, waiting for it.
  bool closed_by_server() const;

  void reset();

 private:
  bool receive_more();

  int fd_;
  std::string input_;
};

}  // namespace fleetplan::server
