// The listener's faults, with a real server; what it does with requests is tested everywhere.

#include "server/connections/listener.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/support/soon.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

TEST(Accepting, EndsOnlyWhenTheSocketIsBroken) {
  for (const int error : {EAGAIN, EWOULDBLOCK})
    EXPECT_EQ(accept_fault(error), AcceptFault::none_waiting) << error;
  for (const int error : {EMFILE, ENFILE, ENOBUFS, ENOMEM}) {
    EXPECT_EQ(accept_fault(error), AcceptFault::exhausted) << error;
  }
  for (const int error : {ECONNABORTED, EINTR, EPROTO, EPERM, ENETDOWN, ENOPROTOOPT, EHOSTDOWN, ENONET,
                          EHOSTUNREACH, EOPNOTSUPP, ENETUNREACH, ETIMEDOUT}) {
    EXPECT_EQ(accept_fault(error), AcceptFault::connection_lost) << error;
  }
  for (const int error : {EBADF, EINVAL, ENOTSOCK, EFAULT})
    EXPECT_EQ(accept_fault(error), AcceptFault::broken) << error;
}

/// A listening socket on a free port.
class Port {
 public:
  Port() : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(fd_, generic, size), 0);
    EXPECT_EQ(::listen(fd_, 100), 0);
    EXPECT_EQ(::getsockname(fd_, generic, &size), 0);
    number_ = ntohs(address.sin_port);
  }
  ~Port() { ::close(fd_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  int fd() const { return fd_; }
  int number() const { return number_; }

 private:
  int fd_;
  int number_ = 0;
};

double cpu_seconds_of_this_process() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A listener whose connections are closed at once.
class BareListener {
 public:
  explicit BareListener(std::function<int(int)> accept = accept_connection)
      : listener_({4, 8, stop_,
                   [this](int fd) -> std::unique_ptr<Connection> {
                     ::close(fd);
                     ++accepted;
                     throw std::runtime_error("closed");
                   },
                   [](const std::string&) {}, [this](const std::string&) { failed = true; },
                   std::move(accept)}),
        thread_([this] { listener_.run(port.fd()); }) {}
  ~BareListener() {
    stop_.raise();
    listener_.stop();
    thread_.join();
  }
  BareListener(const BareListener&) = delete;
  BareListener& operator=(const BareListener&) = delete;

  std::atomic<int> accepted{0};
  std::atomic<bool> failed{false};
  Port port;

 private:
  StopSignal stop_;
  Listener listener_;
  std::thread thread_;
};

TEST(Accepting, GoesOnAfterTransientFaultsWithoutSpinning) {
  std::atomic<int> faults{0};
  static constexpr std::array kErrors{EMFILE, ENFILE, ENOMEM, ENOBUFS, ECONNABORTED, EINTR, EPROTO};
  BareListener bare([&faults](int fd) {
    const int fault = faults;
    if (fault < 20) {
      ++faults;
      errno = kErrors[static_cast<std::size_t>(fault) % kErrors.size()];
      return -1;
    }
    return accept_connection(fd);
  });
  const double before = cpu_seconds_of_this_process();
  const RawConnection client(bare.port.number());
  EXPECT_TRUE(holds_soon([&] { return bare.accepted == 1; }));
  EXPECT_EQ(faults, 20);
  EXPECT_LT(cpu_seconds_of_this_process() - before, 0.3) << "20 pauses of 20 ms";
  EXPECT_FALSE(bare.failed);
}

TEST(Accepting, ReportsABrokenSocketAndDoesNotSpin) {
  BareListener bare;
  ::shutdown(bare.port.fd(), SHUT_RDWR);
  EXPECT_TRUE(holds_soon([&] { return bare.failed.load(); }));
  const double before = cpu_seconds_of_this_process();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(cpu_seconds_of_this_process() - before, 0.2);
}

TEST(ManyConnections, ThatAreIdleOrSlowOccupyNoThread) {
  Settings settings;
  settings.connections = 2;  // 8 may be open
  settings.idle_timeout = settings.read_timeout = std::chrono::minutes(10);
  const TestServer server(settings);
  const std::string head = "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  const std::vector<std::string> beginnings{"", "GET / HT", head + "Content-Length: 10\r\n\r\nabc",
                                            head + "Transfer-Encoding: chunked\r\n\r\n1\r\na\r\n"};
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 7; ++i) {
    slow.push_back(std::make_unique<RawConnection>(server.server.port()));
    slow.back()->send(beginnings[static_cast<std::size_t>(i) % beginnings.size()]);
  }
  auto client = server.client();
  for (int i = 0; i < 10; ++i) {
    const auto answer = client.Get("/healthz");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
  }
  slow[1]->send("TP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(slow[1]->receive().find("HTTP/1.1 404 "), std::string::npos) << "there is no page";
  slow[2]->send("defghij");
  EXPECT_NE(slow[2]->receive().find(R"({"size":10})"), std::string::npos);
  slow[3]->send("2\r\nbc\r\n0\r\n\r\n");
  EXPECT_NE(slow[3]->receive().find(R"({"size":3})"), std::string::npos);
}

TEST(ManyConnections, BeyondTheLimitEndTheOneThatHasWaitedLongest) {
  Settings settings;
  settings.connections = 1;  // 4 may be open
  settings.idle_timeout = settings.read_timeout = std::chrono::minutes(10);
  const TestServer server(settings);
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 20; ++i) {
    slow.push_back(std::make_unique<RawConnection>(server.server.port()));
    slow.back()->send("GET /healthz HTTP/1.1\r\n");
    auto client = server.client();
    const auto answer = client.Get("/healthz");
    ASSERT_TRUE(answer) << i;
    EXPECT_EQ(answer->status, 200);
  }
  EXPECT_TRUE(slow.front()->closed_by_server());
  slow.back()->send("Host: localhost\r\n\r\n");
  EXPECT_NE(slow.back()->receive().find("HTTP/1.1 200 OK"), std::string::npos);
}

TEST(SlowReader, OccupiesNoThread) {
  Settings settings;
  settings.connections = 1;
  const TestServer server(settings);
  RawConnection slow(server.server.port());
  const std::string large =
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "5\r\n\r\nlarge";
  constexpr int kAnswers = 100;  // of 200 kB each, more than the sockets' buffers hold
  std::string all;
  for (int i = 0; i < kAnswers; ++i) all += large;
  slow.send(all);
  auto client = server.client();
  for (int i = 0; i < 20; ++i) {
    const auto answer = client.Get("/healthz");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
  }
  for (int i = 0; i < kAnswers; ++i) EXPECT_EQ(slow.receive().size() > 200'000, true) << i;
}

TEST(SlowReader, HoldsNoMemoryOfItsBody) {
  Settings settings;
  settings.workers = 1;
  settings.queue = 1;
  settings.limits.max_body = 1 << 20;  // all large bodies together have 3 MiB
  Service service;
  service.plan = [](std::string_view body, const api::RequestContext&) {
    return api::Reply{200, api::kJson, std::string(8 * body.size(), 'x')};
  };
  const TestServer server(settings, service);
  const std::string request =
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "1000000\r\n\r\n" +
      std::string(1'000'000, ' ');
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 6; ++i) {
    slow.push_back(std::make_unique<RawConnection>(server.server.port()));
    slow.back()->send(request);
    EXPECT_EQ(slow.back()->receive_past("\r\n"), "HTTP/1.1 200 OK\r\n") << i;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
