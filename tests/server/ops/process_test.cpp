// The executable: its first line, signals, log and exit codes.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/http/cpp_httplib.h"
#include "tests/server/support/soon.h"
#include "tests/server/support/test_server.h"
#include "tests/support/temporary_file.h"

namespace fleetplan::server {
namespace TEST_FILE {

/// A running `fleetplan`, whose output and log can be read.
class Process {
 public:
  /// `prepare`: called in the child before it becomes the server.
  explicit Process(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {}) {
    std::array<int, 2> out{};
    std::array<int, 2> log{};
    if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(log.data(), O_CLOEXEC) != 0) return;
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(out[1], STDOUT_FILENO);
      ::dup2(log[1], STDERR_FILENO);
      if (prepare) prepare();
      std::vector<std::string> words{FLEETPLAN_EXECUTABLE};
      words.insert(words.end(), arguments.begin(), arguments.end());
      std::vector<char*> pointers;
      for (auto& word : words) pointers.push_back(word.data());
      pointers.push_back(nullptr);
      ::execv(pointers[0], pointers.data());
      ::_exit(127);
    }
    ::close(out[1]);
    ::close(log[1]);
    out_ = out[0];
    log_ = log[0];
  }
  ~Process() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(out_);
    ::close(log_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  std::string output_line() const { return line_of(out_); }
  std::string log_line() const { return line_of(log_); }

  /// The next line of the log that contains this; empty if there is none.
  std::string log_line_with(const std::string& part) const {
    std::string line;
    do {
      line = log_line();
    } while (!line.empty() && line.find(part) == std::string::npos);
    return line;
  }

  void signal(int number) const { ::kill(pid_, number); }

  /// Shuts its listening sockets down, as only a fault of the system would. False if that is not permitted.
  bool break_listening_sockets() const {
    const int process = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
    int broken = 0;
    for (int fd = 0; fd < 64; ++fd) {
      const int copy = static_cast<int>(::syscall(SYS_pidfd_getfd, process, fd, 0));
      int listens = 0;
      socklen_t size = sizeof listens;
      if (copy < 0) continue;
      if (::getsockopt(copy, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens != 0) {
        broken += ::shutdown(copy, SHUT_RDWR) == 0 ? 1 : 0;
      }
      ::close(copy);
    }
    ::close(process);
    return broken > 0;
  }

  /// Waits for the end; the exit code, or minus the signal that ended it.
  int exit_code() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  static std::string line_of(int fd) {
    std::string line;
    char c = 0;
    while (::read(fd, &c, 1) == 1 && c != '\n') line += c;
    return line;
  }

  pid_t pid_ = -1;
  int out_ = -1;
  int log_ = -1;
};

int port_in(const std::string& line) { return std::stoi(line.substr(line.rfind(':') + 1)); }

const std::string kGreeting = "fleetplan " FLEETPLAN_VERSION " listening on http://127.0.0.1:";

/// Two robots that change places; `anytime` takes its whole budget of half a minute.
std::string swap_request(const std::string& mode) {
  return R"({"map":{"rows":["..........",".........."]},"robots":[
    {"id":"a","radius":0.3,"linear_speed":1,"angular_speed":1,"start":{"x":0.5,"y":0.5},"goal":{"x":9.5,"y":0.5}},
    {"id":"b","radius":0.3,"linear_speed":1,"angular_speed":1,"start":{"x":9.5,"y":0.5},"goal":{"x":0.5,"y":0.5}}],
    "options":{"time_budget_ms":30000,"mode":")" +
         mode + "\"}}";
}

TEST(Process, PrintsItsUrlAndLogsRequestsAsJson) {
  Process process({"--port", "0", "--workers", "1"});
  const std::string line = process.output_line();
  ASSERT_EQ(line.find(kGreeting), 0u) << line;
  httplib::Client client("127.0.0.1", port_in(line));
  const auto health = client.Get("/healthz?secret=1", httplib::Headers{{"X-Request-Id", "abc"}});
  ASSERT_TRUE(health);
  EXPECT_EQ(health->status, 200);
  const std::string log = process.log_line_with("healthz");
  for (const char* part : {R"("time":"2)", R"("level":"info")", R"("id":"abc")", R"("method":"GET")",
                           R"("path":"/healthz")", R"("status":200)", R"("ms":)", R"("peer":"127.0.0.1:)"}) {
    EXPECT_NE(log.find(part), std::string::npos) << log;
  }
  EXPECT_EQ(log.find("secret"), std::string::npos) << log;
}

TEST(Process, LogsTheTraceAndTheForwardedAddresses) {
  Process process({"--port", "0", "--workers", "1"});
  httplib::Client client("127.0.0.1", port_in(process.output_line()));
  const httplib::Headers sent{{"traceparent", "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"},
                              {"X-Forwarded-For", std::string(1000, 'x') + ", 192.0.2.7"}};
  ASSERT_TRUE(client.Get("/healthz", sent));
  const auto line = nlohmann::json::parse(process.log_line_with("healthz"), nullptr, false);
  ASSERT_TRUE(line.is_object());
  EXPECT_EQ(line.value("trace_id", ""), "0af7651916cd43dd8448eb211c80319c");
  const std::string forwarded = line.value("forwarded", "");
  EXPECT_TRUE(forwarded.ends_with(", 192.0.2.7")) << forwarded;
  EXPECT_EQ(forwarded.size(), 256u);
  ASSERT_TRUE(client.Get("/readyz", httplib::Headers{{"traceparent", "none"}}));
  const std::string plain = process.log_line_with("readyz");
  EXPECT_EQ(plain.find("trace_id"), std::string::npos) << plain;
  EXPECT_EQ(plain.find("forwarded"), std::string::npos) << plain;
}

TEST(Process, LogsAPathOfInvalidUtf8AsValidJson) {
  Process process({"--port", "0", "--workers", "1"});
  RawConnection client(port_in(process.output_line()));
  client.send("GET /nowhere/\xff\"\xc3 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(client.receive().find("not_found"), std::string::npos);
  const std::string log = process.log_line_with("/nowhere");
  const auto line = nlohmann::json::parse(log, nullptr, false);
  ASSERT_TRUE(line.is_object()) << log;
  EXPECT_EQ(line["path"], "/nowhere/\uFFFD\"\uFFFD");
}

TEST(Process, LogsTheOutcomeOfAPlan) {
  Process process({"--port", "0", "--workers", "1"});
  httplib::Client client("127.0.0.1", port_in(process.output_line()));
  const auto swapped = client.Post("/v1/plan", swap_request("first"), "application/json");
  ASSERT_TRUE(swapped);
  const std::string log = process.log_line_with("/v1/plan");
  for (const char* part : {R"("status":200)", R"("outcome":"solved")", R"("planned":2)", R"("unplanned":0)",
                           R"("flowtime":)", R"("plan_ms":)", R"("queue_ms":)"}) {
    EXPECT_NE(log.find(part), std::string::npos) << part << ": " << log;
  }
  const auto invalid = client.Post("/v1/plan", "{}", "application/json");
  ASSERT_TRUE(invalid);
  const std::string refusal = process.log_line_with("/v1/plan");
  EXPECT_NE(refusal.find(R"("code":"invalid_request")"), std::string::npos) << refusal;
  EXPECT_EQ(refusal.find("outcome"), std::string::npos) << refusal;
}

/// Waits until a series has this value.
void await_metric(int port, const std::string& series_and_value) {
  httplib::Client probe("127.0.0.1", port);
  EXPECT_TRUE(holds_soon([&] {
    const auto metrics = probe.Get("/metrics");
    return metrics && metrics->body.find('\n' + series_and_value + '\n') != std::string::npos;
  })) << series_and_value;
}

TEST(Process, LogsNoErrorWhenAClientLeaves) {
  Process process({"--port", "0", "--workers", "1", "--queue", "1"});
  const int port = port_in(process.output_line());
  const auto send = [](RawConnection& client, const std::string& path, const std::string& body) {
    client.send("POST " + path +
                " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
                std::to_string(body.size()) + "\r\n\r\n" + body);
  };
  RawConnection busy(port);
  send(busy, "/v1/plan", swap_request("anytime"));
  RawConnection in_the_lane(port);
  send(in_the_lane, "/v1/plan", swap_request("anytime"));
  await_metric(port, "fleetplan_workers_busy 2");
  {
    RawConnection leaving(port);
    send(leaving, "/v1/plan", swap_request("anytime"));
    await_metric(port, "fleetplan_improvements_paused 1");
  }
  const std::string log = process.log_line_with(R"("status":499)");
  EXPECT_EQ(log.find(R"("code")"), std::string::npos) << log;
}

TEST(Process, LogsItsStartAndItsEnd) {
  Process process({"--port", "0", "--admin-port", "0", "--workers", "1"});
  const int port = port_in(process.output_line());
  const std::string started = process.log_line();
  EXPECT_NE(started.find(R"("message":"started","version":")"), std::string::npos) << started;
  EXPECT_NE(started.find(R"("url":"http://127.0.0.1:)" + std::to_string(port) + '"'), std::string::npos);
  EXPECT_NE(started.find(R"("workers":1)"), std::string::npos) << started;
  process.signal(SIGTERM);
  const std::string draining = process.log_line();
  EXPECT_NE(draining.find(R"("message":"draining","delay_ms":0,"drain_ms":10000)"), std::string::npos)
      << draining;
  EXPECT_NE(process.log_line().find(R"("message":"stopped")"), std::string::npos);
  EXPECT_EQ(process.exit_code(), 0);
}

TEST(Process, ServesAndEndsWhenNobodyReadsItsLog) {
  Process process({"--port", "0", "--workers", "1"});
  const int port = port_in(process.output_line());
  httplib::Client client("127.0.0.1", port);
  client.set_keep_alive(true);
  const httplib::Headers long_id{{"X-Request-Id", std::string(128, 'a')}};
  for (int i = 0; i < 6000; ++i) {  // 2 MB of log; the pipe holds 64 KiB and the queue 1 MiB
    const auto health = client.Get("/healthz", long_id);
    ASSERT_TRUE(health) << i;
    ASSERT_EQ(health->status, 200);
  }
  const auto metrics = client.Get("/metrics");
  ASSERT_TRUE(metrics);
  EXPECT_NE(metrics->body.find("\nfleetplan_log_lines_dropped_total "), std::string::npos);
  EXPECT_EQ(metrics->body.find("\nfleetplan_log_lines_dropped_total 0\n"), std::string::npos);
  process.signal(SIGTERM);
  EXPECT_EQ(process.exit_code(), 0);
}

TEST(Process, SendsNoLogToClientsWhenItsStandardDescriptorsAreClosed) {
  // Nobody learns the port from the output, so another server finds a free one first.
  std::string port;
  {
    Process other({"--port", "0", "--workers", "1"});
    port = std::to_string(port_in(other.output_line()));
  }
  Process process({"--port", port, "--workers", "1"}, [] {
    for (int fd = 0; fd <= 2; ++fd) ::close(fd);
  });
  httplib::Client client("127.0.0.1", std::stoi(port));
  EXPECT_TRUE(holds_soon([&] { return client.Get("/healthz") != nullptr; }));
  RawConnection raw(std::stoi(port));
  for (int i = 0; i < 3; ++i) {
    raw.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(raw.receive().find("HTTP/1.1 200 OK\r\n"), 0U);
  }
  process.signal(SIGTERM);
  EXPECT_EQ(raw.receive_all(), "");
  EXPECT_EQ(process.exit_code(), 0);
}

TEST(Process, WarnsOfUnknownEnvironmentVariables) {
  Process process({"--port", "0", "--workers", "1"}, [] {
    ::setenv("FLEETPLAN_MAX_BODDY", "1MiB", 1);
    ::setenv("FLEETPLAN_MAX_BODY", "1MiB", 1);
  });
  process.output_line();
  const std::string warning = process.log_line_with("unknown environment variable");
  EXPECT_NE(warning.find(R"("level":"warning")"), std::string::npos) << warning;
  EXPECT_NE(warning.find(R"("name":"FLEETPLAN_MAX_BODDY")"), std::string::npos) << warning;
  process.signal(SIGTERM);
  EXPECT_EQ(process.log_line_with("unknown environment variable"), "");
}

TEST(Process, LogsAdminRequestsAtDebugLevelOnly) {
  for (const std::string& level : {std::string("info"), std::string("debug")}) {
    Process process({"--port", "0", "--admin-port", "0", "--workers", "1", "--log-level", level});
    process.output_line();
    httplib::Client client("127.0.0.1", port_in(process.output_line()));
    ASSERT_TRUE(client.Get("/healthz"));
    process.signal(SIGTERM);
    EXPECT_EQ(process.log_line_with("/healthz").empty(), level == "info");
  }
}

TEST(Process, ExitsWithZeroAfterSigterm) {
  for (const int number : {SIGTERM, SIGINT}) {
    Process process({"--port", "0", "--workers", "1"});
    process.output_line();
    process.signal(number);
    EXPECT_EQ(process.exit_code(), 0);
  }
}

TEST(Process, ExitsWithOneWhenItCannotAcceptConnectionsAnyMore) {
  for (const bool admin : {false, true}) {
    std::vector<std::string> arguments{"--port", "0", "--workers", "1"};
    if (admin) arguments.insert(arguments.end(), {"--admin-port", "0"});
    Process process(arguments);
    RawConnection open(port_in(process.output_line()));
    open.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_NE(open.receive().find("200 OK"), std::string::npos);
    if (!process.break_listening_sockets()) GTEST_SKIP() << "needs the right to trace the process";
    EXPECT_NE(process.log_line_with("no more connections can be accepted"), "");
    EXPECT_EQ(process.exit_code(), 1);
  }
}

#ifndef FLEETPLAN_ADDRESS_SANITIZER  // the sanitizers use descriptors, too, to judge types
TEST(Process, ServesNewClientsWhenItsDescriptorsAreUsedUp) {
  Process process({"--port", "0", "--workers", "1", "--idle-timeout-ms", "600000"}, [] {
    const rlimit few{48, 48};
    ::setrlimit(RLIMIT_NOFILE, &few);
  });
  const int port = port_in(process.output_line());
  std::vector<std::unique_ptr<RawConnection>> idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(std::make_unique<RawConnection>(port));
    if (i % 40 != 0) continue;
    const auto health = httplib::Client("127.0.0.1", port).Get("/healthz");
    ASSERT_TRUE(health) << i;
    EXPECT_EQ(health->status, 200);
  }
  const auto metrics = httplib::Client("127.0.0.1", port).Get("/metrics");
  ASSERT_TRUE(metrics);
  process.signal(SIGTERM);
  EXPECT_EQ(process.exit_code(), 0);
}
#endif

TEST(Process, FailsOnATakenPort) {
  Process first({"--port", "0", "--workers", "1"});
  const std::string port = std::to_string(port_in(first.output_line()));
  Process second({"--port", port, "--workers", "1"});
  EXPECT_EQ(second.log_line(), "fleetplan: cannot listen on 127.0.0.1:" + port + ": Address already in use");
  EXPECT_EQ(second.exit_code(), 1);
}

TEST(Process, FailsOnATakenAdminPort) {
  Process first({"--port", "0", "--workers", "1"});
  const std::string port = std::to_string(port_in(first.output_line()));
  Process second({"--port", "0", "--admin-port", port, "--workers", "1"});
  EXPECT_EQ(second.log_line(),
            "fleetplan: cannot listen on 127.0.0.1:" + port + ": Address already in use (--admin-port)");
  EXPECT_EQ(second.exit_code(), 1);
}

TEST(Process, PrintsTheUrlOfItsAdminPort) {
  Process process({"--port", "0", "--admin-port", "0", "--workers", "1"});
  const int main_port = port_in(process.output_line());
  const std::string line = process.output_line();
  EXPECT_EQ(line.find("fleetplan " FLEETPLAN_VERSION " health and metrics on http://127.0.0.1:"), 0u) << line;
  ASSERT_NE(port_in(line), main_port);
  const auto ready = httplib::Client("127.0.0.1", port_in(line)).Get("/readyz");
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->status, 200);
}

TEST(Process, FailsOnAnEmptyTokenFile) {
  const support::TemporaryFile empty("\n");
  Process process({"--port", "0", "--auth-token-file", empty.path()});
  EXPECT_EQ(process.log_line(), "--auth-token-file: " + empty.path() + ": it is empty");
  EXPECT_EQ(process.exit_code(), 2);
}

TEST(Process, FailsOnABadValueWithAMessage) {
  Process bad({"--port", "70000"});
  EXPECT_NE(bad.log_line().find("--port"), std::string::npos);
  EXPECT_EQ(bad.exit_code(), 2);
  Process version({"--version"});
  EXPECT_EQ(version.output_line(), "fleetplan " FLEETPLAN_VERSION);
  EXPECT_EQ(version.exit_code(), 0);
}

TEST(Process, ProbesTheHealthOfARunningService) {
  Process service({"--port", "0", "--workers", "1"});
  const std::string port = std::to_string(port_in(service.output_line()));
  Process asking({"--healthcheck", "--port", port});
  EXPECT_EQ(asking.exit_code(), 0);
  service.signal(SIGTERM);
  EXPECT_EQ(service.exit_code(), 0);
  Process again({"--healthcheck", "--port", port});
  EXPECT_EQ(again.log_line().find("fleetplan: no answer from 127.0.0.1 port " + port + ": "), 0u);
  EXPECT_EQ(again.exit_code(), 1);
}

/// Sends the long request from a thread of its own and waits until the server works on it: its status, 0
/// without an answer.
std::future<int> long_request(int port) {
  auto status = std::async(std::launch::async, [port] {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(150);
    for (;;) {
      const auto result = client.Post("/v1/plan", swap_request("anytime"), "application/json");
      if (!result) return 0;
      if (result->body.find("overloaded") == std::string::npos) return result->status;
    }  // the probe below held the worker
  });
  // With one worker and no queue, another job is refused as soon as the long one has begun.
  httplib::Client probe("127.0.0.1", port);
  while (status.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    const auto result = probe.Post("/v1/validate", "{}", "application/json");
    if (!result || result->status == 503) break;
  }
  return status;
}

void await_unready(int port) {
  httplib::Client probe("127.0.0.1", port);
  for (int status = 200; status == 200;) {
    const auto ready = probe.Get("/readyz");
    status = ready ? ready->status : 0;
  }
}

TEST(Process, StopsPlansWhenTheDrainTakesTooLong) {
  Process process({"--port", "0", "--workers", "1", "--queue", "0", "--drain-ms", "100"});
  auto request = long_request(port_in(process.output_line()));
  process.signal(SIGTERM);
  EXPECT_EQ(request.get(), 200);
  EXPECT_EQ(process.exit_code(), 0);
}

TEST(Process, ServesRequestsWhileNotReadyDuringTheDelay) {
  Process process({"--port", "0", "--workers", "1", "--drain-delay-ms", "120000"});
  const int port = port_in(process.output_line());
  process.signal(SIGTERM);
  await_unready(port);
  httplib::Client client("127.0.0.1", port);
  const auto served = client.Post("/v1/validate", "{}", "application/json");
  ASSERT_TRUE(served);
  EXPECT_EQ(served->status, 422) << "not refused: " << served->body;
  process.signal(SIGINT);
  EXPECT_EQ(process.exit_code(), 128 + SIGINT);
}

TEST(Process, ExitsWithZeroAfterTheDelay) {
  Process process({"--port", "0", "--workers", "1", "--drain-delay-ms", "50"});
  process.output_line();
  process.signal(SIGTERM);
  EXPECT_EQ(process.exit_code(), 0);
}

TEST(Process, RejectsNewJobsWhileItFinishesRunningOnes) {
  Process process({"--port", "0", "--workers", "1", "--queue", "0", "--drain-ms", "3000"});
  const int port = port_in(process.output_line());
  auto request = long_request(port);
  process.signal(SIGTERM);
  await_unready(port);
  httplib::Client client("127.0.0.1", port);
  for (int status = 0; status != 503;) {  // /readyz changes first
    const auto refused = client.Post("/v1/validate", "{}", "application/json");
    ASSERT_TRUE(refused);
    status = refused->status;
    if (status != 503) continue;
    EXPECT_NE(refused->body.find("draining"), std::string::npos) << refused->body;
    EXPECT_TRUE(refused->has_header("Retry-After"));
    EXPECT_EQ(refused->get_header_value("Connection"), "close");
  }
  EXPECT_EQ(request.get(), 200);
  EXPECT_EQ(process.exit_code(), 0);
}

TEST(Process, ExitsAtOnceOnASecondInterrupt) {
  Process process({"--port", "0", "--workers", "1", "--queue", "0", "--drain-ms", "120000"});
  const int port = port_in(process.output_line());
  auto request = long_request(port);
  process.signal(SIGTERM);
  await_unready(port);
  process.signal(SIGINT);
  EXPECT_EQ(process.exit_code(), 128 + SIGINT);
  EXPECT_EQ(request.get(), 0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
