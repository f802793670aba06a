#include "server/ops/request_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>

namespace fleetplan::server {
namespace TEST_FILE {

/// A pipe in place of stderr.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(::pipe2(ends_.data(), O_CLOEXEC), 0); }
  ~Pipe() {
    close_reader();
    ::close(ends_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writer() const { return ends_[1]; }

  std::string read_line() const {
    std::string line;
    char c = 0;
    while (::read(ends_[0], &c, 1) == 1 && c != '\n') line += c;
    return line;
  }

  void close_reader() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }

 private:
  std::array<int, 2> ends_{};
};

TEST(RequestLog, WritesALineOfJsonForEachEvent) {
  const Pipe pipe;
  const RequestLog log("info", pipe.writer());
  log.warn("unknown environment variable", {{"name", "FLEETPLAN_X"}});
  const auto line = nlohmann::json::parse(pipe.read_line(), nullptr, false);
  ASSERT_TRUE(line.is_object());
  EXPECT_EQ(line["level"], "warning");
  EXPECT_EQ(line["name"], "FLEETPLAN_X");
}

TEST(RequestLog, DropsAndCountsLinesThatNobodyReadsWithoutWaiting) {
  std::signal(SIGPIPE, SIG_IGN);  // as cpp-httplib does in the server
  Pipe pipe;
  const RequestLog log("info", pipe.writer());
  const std::string message(1000, 'x');
  for (int i = 0; i < 5000; ++i) log.info(message);  // 5 MB; pipe, queue and writer hold two at most
  EXPECT_GT(log.dropped(), 2900U);
  EXPECT_LT(log.dropped(), 5000U);
  const auto begin = std::chrono::steady_clock::now();
  log.flush();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  EXPECT_NE(pipe.read_line().find(R"("level":"info")"), std::string::npos);
  pipe.close_reader();  // which ends the write that waits for it
  log.flush();
  EXPECT_GT(log.dropped(), 4900U);  // all but what the pipe holds
}

TEST(RequestLog, WritesAllLinesOnceTheyAreRead) {
  const Pipe pipe;
  const RequestLog log("info", pipe.writer());
  const int lines = 300;
  for (int i = 0; i < lines; ++i) log.info(std::to_string(i) + std::string(1000, ' '));
  for (int i = 0; i < lines; ++i) {
    EXPECT_NE(pipe.read_line().find(R"("message":")" + std::to_string(i) + ' '), std::string::npos) << i;
  }
  EXPECT_EQ(log.dropped(), 0U);
}

TEST(RequestLog, CountsLinesThatTheDescriptorDoesNotTake) {
  const RequestLog log("info", -1);
  log.info("lost");
  log.flush();
  EXPECT_EQ(log.dropped(), 1U);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
