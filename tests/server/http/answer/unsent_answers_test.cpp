
#include "server/http/answer/unsent_answers.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace fleetplan::server {
namespace TEST_FILE {

/// More than the buffers of a pair of sockets hold.
constexpr std::size_t kLarge = 4 << 20;

/// A client and its answer.
class Client {
 public:
  explicit Client(UnsentAnswers& all) {
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()), 0);
    socket_ = std::make_unique<Socket>(ends_[0]);
    answer_ = std::make_unique<UnsentAnswers::Answer>(all, *socket_);
  }
  ~Client() { ::close(ends_[1]); }

  UnsentAnswers::Answer& answer() { return *answer_; }
  Socket& socket() { return *socket_; }
  void end_answer() { answer_.reset(); }

  /// Reads until nothing more has arrived.
  std::size_t read() {
    std::size_t total = 0;
    std::array<char, 65536> buffer{};
    for (ssize_t got = 1; got > 0; total += static_cast<std::size_t>(std::max<ssize_t>(got, 0))) {
      got = ::recv(ends_[1], buffer.data(), buffer.size(), MSG_DONTWAIT);
    }
    return total;
  }

 private:
  std::array<int, 2> ends_{};
  std::unique_ptr<Socket> socket_;
  std::unique_ptr<UnsentAnswers::Answer> answer_;
};

TEST(UnsentAnswers, HoldNothingOfAnAnswerThatIsAcceptedAtOnce) {
  UnsentAnswers all(1 << 20);
  Client client(all);
  EXPECT_TRUE(client.answer().send("hello"));
  EXPECT_FALSE(client.answer().has_rest());
  EXPECT_EQ(all.stats().bytes, 0U);
}

TEST(UnsentAnswers, ArriveWholeHoweverSlowlyTheyAreRead) {
  UnsentAnswers all(1 << 30);
  Client client(all);
  EXPECT_TRUE(client.answer().send(std::string(kLarge, 'a')));
  EXPECT_TRUE(client.answer().send(std::string(kLarge, 'b')));
  EXPECT_GT(all.stats().bytes, kLarge);
  std::size_t read = 0;
  while (client.answer().has_rest()) {
    read += client.read();
    ASSERT_TRUE(client.answer().send_rest());
  }
  EXPECT_EQ(read + client.read(), 2 * kLarge);
  EXPECT_EQ(all.stats().bytes, 0U);
  EXPECT_EQ(all.stats().dropped, 0U);
}

TEST(UnsentAnswers, DropTheClientThatHasAcceptedNothingForLongest) {
  UnsentAnswers all(2 * kLarge);
  Client stalled(all);
  Client reads(all);
  EXPECT_TRUE(stalled.answer().send(std::string(kLarge, 'a')));
  EXPECT_TRUE(reads.answer().send(std::string(kLarge, 'b')));
  EXPECT_TRUE(stalled.answer().send_rest());  // nothing is accepted
  reads.read();
  EXPECT_GT(reads.answer().send_rest().value_or(0), 0U);
  Client newest(all);
  EXPECT_TRUE(newest.answer().send(std::string(kLarge, 'c')));
  EXPECT_EQ(all.stats().dropped, 1U);
  EXPECT_LE(all.stats().bytes, 2 * kLarge);
  EXPECT_EQ(stalled.answer().send_rest(), std::nullopt);
  EXPECT_TRUE(stalled.answer().has_rest()) << "it did not arrive";
  EXPECT_FALSE(stalled.answer().send("more"));
  EXPECT_TRUE(stalled.socket().peer_gone()) << "its connection ends";
  EXPECT_TRUE(reads.answer().send_rest());
  EXPECT_TRUE(newest.answer().send_rest());
}

TEST(UnsentAnswers, KeepTheNewestWhateverItsSize) {
  UnsentAnswers all(kLarge / 2);
  Client first(all);
  Client second(all);
  EXPECT_TRUE(first.answer().send(std::string(kLarge, 'a')));
  EXPECT_TRUE(second.answer().send(std::string(kLarge, 'b')));
  EXPECT_EQ(first.answer().send_rest(), std::nullopt);
  EXPECT_LE(all.stats().bytes, kLarge);
  EXPECT_TRUE(second.answer().send(std::string(kLarge, 'b'))) << "alone, it may grow";
  EXPECT_EQ(all.stats().dropped, 1U);
}

TEST(UnsentAnswers, GiveTheirMemoryBackWhenTheConnectionEnds) {
  UnsentAnswers all(kLarge);
  Client client(all);
  EXPECT_TRUE(client.answer().send(std::string(kLarge, 'a')));
  EXPECT_GT(all.stats().bytes, 0U);
  client.end_answer();
  EXPECT_EQ(all.stats().bytes, 0U);
  EXPECT_EQ(all.stats().dropped, 0U);
}

TEST(UnsentAnswers, OfManyThreadsStayWithinTheBudget) {
  UnsentAnswers all(kLarge);
  std::atomic<std::size_t> arrived{0};
  std::atomic<std::size_t> lost{0};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (int round = 0; round < 30; ++round) {
        Client client(all);
        bool usable = client.answer().send(std::string(kLarge / 4, 'a'));
        while (usable && client.answer().has_rest() && t % 2 == 0) {  // the others read nothing
          client.read();
          usable = client.answer().send_rest().has_value();
        }
        EXPECT_LE(all.stats().bytes, kLarge);
        usable && !client.answer().has_rest() ? ++arrived : ++lost;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(arrived + lost, 180U);
  EXPECT_GT(arrived, 0U);
  EXPECT_EQ(all.stats().bytes, 0U);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
