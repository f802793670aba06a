#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/jobs/job_runner.h"

namespace fleetplan::server {
namespace TEST_FILE {

/// A connection whose other end a test may close.
struct Pair {
  Pair() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0); }
  ~Pair() { leave(); }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;

  void leave() {
    if (ends[1] >= 0) ::close(ends[1]);
    ends[1] = -1;
  }

  std::array<int, 2> ends{-1, -1};
};

/// True as soon as `stop` is requested; false after a generous while without that.
bool is_stopped(const std::stop_source& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop.get_token(), std::chrono::seconds(20), [] { return false; });
  return stop.stop_requested();
}

TEST(PeerWatch, StopsTheJobOfAClientThatLeaves) {
  PeerWatch watch;
  Pair stays;
  Pair leaves;
  const Socket staying(stays.ends[0]);
  const Socket leaving(leaves.ends[0]);
  std::stop_source stayer_stop;
  std::stop_source leaver_stop;
  const PeerWatch::Watched one(watch, staying, stayer_stop);
  const PeerWatch::Watched other(watch, leaving, leaver_stop);
  leaves.leave();
  EXPECT_TRUE(is_stopped(leaver_stop));
  EXPECT_TRUE(other.gone());
  EXPECT_FALSE(stayer_stop.stop_requested());
  EXPECT_FALSE(one.gone());
}

TEST(PeerWatch, WakesAgainAfterAVeryShortJob) {
  PeerWatch watch;
  for (int i = 0; i < 5; ++i) {
    std::this_thread::sleep_for(2 * PeerWatch::kPeriod);  // it has nothing to watch and sleeps
    {
      const Pair brief;
      const Socket socket(brief.ends[0]);
      const PeerWatch::Watched gone_before_it_wakes(watch, socket, std::stop_source());
    }
    std::this_thread::sleep_for(2 * PeerWatch::kPeriod);
    Pair leaves;
    const std::stop_source leaver_stop;
    const Socket leaving(leaves.ends[0]);
    const PeerWatch::Watched watched(watch, leaving, leaver_stop);
    leaves.leave();
    ASSERT_TRUE(is_stopped(leaver_stop)) << "in round " << i;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
