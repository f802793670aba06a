#include "server/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace fleetplan::server {
namespace {

constexpr std::chrono::milliseconds kLong{60'000};

/// Occupies a worker until released.
class Blocker {
 public:
  WorkerPool::Job job() {
    return [this] {
      running_.set_value();
      release_.get_future().wait();
    };
  }
  void await_running() { running_.get_future().wait(); }
  void release() { release_.set_value(); }

 private:
  std::promise<void> running_;
  std::promise<void> release_;
};

TEST(WorkerPool, RunsAllJobsOfManyThreads) {
  std::atomic<int> sum{0};
  {
    WorkerPool pool(3, 1000);
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 100; ++i) EXPECT_TRUE(pool.submit([&] { ++sum; }));
      });
    }
    for (auto& thread : threads) thread.join();
  }
  EXPECT_EQ(sum, 800);
}

TEST(WorkerPool, RefusesAJobBeyondItsQueue) {
  Blocker blocker;
  WorkerPool pool(1, 2);
  ASSERT_TRUE(pool.submit(blocker.job()));
  blocker.await_running();
  EXPECT_TRUE(pool.submit([] {}));
  EXPECT_TRUE(pool.submit([] {}));
  EXPECT_FALSE(pool.submit([] {}));
  EXPECT_EQ(pool.queued(), 2u);
  EXPECT_GE(pool.retry_after_s(), 1);
  blocker.release();
}

TEST(WorkerPool, RefusesABurstWhileJobsAreLong) {
  Blocker blocker;
  WorkerPool pool(1, 1, 100);
  ASSERT_TRUE(pool.submit(blocker.job()));
  blocker.await_running();
  EXPECT_TRUE(pool.submit([] {}));
  std::this_thread::sleep_for(WorkerPool::kShortWait);
  EXPECT_FALSE(pool.submit([] {})) << "the running job has taken longer than a short wait";
  blocker.release();
}

TEST(WorkerPool, BoundsABurstHoweverShortTheJobs) {
  Blocker blocker;
  WorkerPool pool(1, 1, 3);
  ASSERT_TRUE(pool.submit(blocker.job()));
  blocker.await_running();
  int taken = 0;
  while (pool.submit([] {})) ++taken;
  EXPECT_GE(taken, 1);
  EXPECT_LE(taken, 1 + 3);
  blocker.release();
}

TEST(WorkerPool, WithoutAQueueStillGivesIdleWorkersJobs) {
  Blocker blocker;
  WorkerPool pool(1, 0);
  EXPECT_TRUE(pool.submit(blocker.job()));
  EXPECT_FALSE(pool.submit([] {}));
  blocker.release();
}

TEST(WorkerPool, TellsWhenAJobHasFinished) {
  Blocker blocker;
  WorkerPool pool(1, 1);
  const auto ticket = pool.submit(blocker.job());
  ASSERT_TRUE(ticket);
  EXPECT_FALSE(pool.wait_for(*ticket, std::chrono::milliseconds(1)));
  blocker.release();
  EXPECT_TRUE(pool.wait_for(*ticket, kLong));
}

TEST(WorkerPool, GivesBackAJobThatWaitsAndItsPlace) {
  Blocker blocker;
  WorkerPool pool(1, 1);
  const auto running = pool.submit(blocker.job());
  blocker.await_running();
  bool ran = false;
  const auto waiting = pool.submit([&] { ran = true; });
  ASSERT_TRUE(waiting);
  EXPECT_FALSE(pool.withdraw(*running));
  EXPECT_TRUE(pool.withdraw(*waiting));
  EXPECT_TRUE(pool.submit([] {}));
  blocker.release();
  EXPECT_TRUE(pool.wait_for(*running, kLong));
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace fleetplan::server
