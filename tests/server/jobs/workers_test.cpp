#include "server/jobs/workers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <stop_token>
#include <thread>
#include <vector>

#include "tests/server/support/soon.h"
#include "tests/server/support/worker_jobs.h"

namespace fleetplan::server {
namespace TEST_FILE {

TEST(Workers, RunAtMostOneJobPerWorker) {
  Workers workers({3, 1000});
  std::atomic<int> computing{0};
  std::atomic<int> done{0};
  std::vector<std::thread> threads;
  threads.reserve(8);
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        do_job(workers, [&](Workers::Job&) {
          EXPECT_LE(++computing, 3);
          std::this_thread::yield();
          --computing;
          ++done;
        });
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(done, 1600);
  EXPECT_EQ(workers.load().running, 0u);
  EXPECT_EQ(workers.load().waiting, 0u);
}

TEST(Workers, RejectAJobBeyondTheQueue) {
  Workers workers({1, 2});
  auto running = admit(workers);
  auto second = admit(workers);
  auto third = admit(workers);
  ASSERT_TRUE(running && second && third);
  EXPECT_FALSE(admit(workers));
  EXPECT_GE(workers.retry_after_s(), 1);
  second.reset();
  EXPECT_TRUE(admit(workers)) << "a job that ends frees its place, even if its turn never came";
}

TEST(Workers, RejectABurstWhileJobsAreLong) {
  Workers workers({1, 1, 100});
  auto running = admit(workers);
  ASSERT_TRUE(take_turn(*running));
  const auto waiting = admit(workers);
  EXPECT_TRUE(waiting);
  std::this_thread::sleep_for(Schedule::kShortWait);
  EXPECT_FALSE(admit(workers)) << "the running job has taken longer than a short wait";
}

TEST(Workers, AcceptABurstOfShortJobsBesideALongOne) {
  Workers workers({2, 1, 100});
  do_job(workers, [](Workers::Job&) {});
  auto long_one = admit(workers);
  ASSERT_TRUE(take_turn(*long_one));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::vector<JobPtr> jobs;
  for (int k = 0; k < 50; ++k) {
    auto job = admit(workers);
    ASSERT_TRUE(job) << "no job that has ended was long";
    jobs.push_back(std::move(job));
  }
}

TEST(Workers, LimitABurstHoweverShortTheJobs) {
  Workers workers({1, 1, 3});
  std::vector<JobPtr> jobs;
  while (auto job = admit(workers)) jobs.push_back(std::move(job));
  EXPECT_EQ(jobs.size(), 1u + 1u + 3u);
}

TEST(Workers, AcceptOneJobEachWithoutAQueue) {
  Workers workers({2, 0});
  const auto one = admit(workers);
  const auto other = admit(workers);
  EXPECT_TRUE(one && other);
  EXPECT_FALSE(admit(workers));
}

TEST(Workers, GiveTurnsInOrder) {
  Workers workers({1, 10});
  auto first = admit(workers);
  ASSERT_TRUE(take_turn(*first));
  std::vector<int> order;  // one job at a time writes to it
  std::vector<std::thread> threads;
  for (int k = 0; k < 5; ++k) {
    threads.push_back(start_job(workers, [&order, k](Workers::Job&) { order.push_back(k); }));
    while (workers.load().waiting != static_cast<std::size_t>(k) + 1) std::this_thread::yield();
  }
  first.reset();
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(Workers, StopWaitingWhenTheJobsStopConditionIsMet) {
  Workers workers({1, 10});
  auto running = admit(workers);
  ASSERT_TRUE(take_turn(*running));
  auto late = admit(workers);
  EXPECT_FALSE(take_turn(*late, within(std::chrono::milliseconds(5))));
  auto left = admit(workers);
  std::stop_source stop;
  std::jthread leaver([&] {
    while (workers.load().waiting == 0) std::this_thread::yield();
    stop.request_stop();
  });
  EXPECT_FALSE(take_turn(*left, core::StopCondition(Workers::Clock::time_point::max(), stop.get_token())));
  EXPECT_EQ(workers.load().waiting, 0u);
  running.reset();
  auto next = admit(workers);
  EXPECT_TRUE(take_turn(*next)) << "jobs that stopped waiting get no turn";
}

/// An improvement that asks before every round whether it may go on.
class Improving {
 public:
  explicit Improving(Workers& workers)
      : thread_(start_job(workers, [this](Workers::Job& job) {
          while (job.may_improve(core::StopCondition(deadline, stop.get_token())) && !end_) ++rounds_;
          ended_ = true;
        })) {
    EXPECT_TRUE(goes_on());
  }
  ~Improving() {
    end_ = true;
    stop.request_stop();
    thread_.join();
  }
  Improving(const Improving&) = delete;
  Improving& operator=(const Improving&) = delete;

  bool goes_on() const {
    const int rounds = rounds_;
    return holds_soon([&] { return rounds_ > rounds; });
  }
  bool has_ended() const { return ended_; }

  std::stop_source stop;

 private:
  const Workers::Clock::time_point deadline = Workers::Clock::now() + std::chrono::minutes(10);
  std::atomic<int> rounds_{0};
  std::atomic<bool> end_{false};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

TEST(Improvements, GiveTheirTurnToOthersAndGoOnAfterwards) {
  Workers workers({1, 10});
  const Improving improving(workers);
  do_job(workers, [&](Workers::Job&) {
    EXPECT_EQ(workers.load().paused, 1u);
    EXPECT_EQ(workers.load().running, 1u);
  });
  EXPECT_TRUE(improving.goes_on());
  EXPECT_EQ(workers.load().paused, 0u);
}

TEST(Improvements, EndWhenTheirClientLeavesInAPause) {
  Workers workers({1, 10});
  Improving improving(workers);
  do_job(workers, [&](Workers::Job&) {
    improving.stop.request_stop();
    EXPECT_TRUE(holds_soon([&] { return improving.has_ended(); }));
    EXPECT_EQ(workers.load().paused, 0u);
  });
}

TEST(Improvements, BeyondOnePausedPerWorkerEndWithWhatTheyHave) {
  Workers workers({1, 10});
  const Improving first(workers);
  const Improving second(workers);
  EXPECT_FALSE(first.has_ended());
  do_job(workers, [&](Workers::Job&) {
    EXPECT_EQ(workers.load().paused, 1u);
    EXPECT_TRUE(holds_soon([&] { return second.has_ended(); }));
    EXPECT_EQ(workers.load().ended_early, 1u);
  });
  EXPECT_TRUE(first.goes_on());
}

TEST(Workers, SpreadTheReturnOfRefusedClients) {
  Workers workers({1, 0});
  const auto running = admit(workers);
  std::vector<int> seconds(20);
  for (int& s : seconds) s = workers.retry_after_s();
  EXPECT_EQ(*std::min_element(seconds.begin(), seconds.end()), 1);
  EXPECT_LE(*std::max_element(seconds.begin(), seconds.end()), 2);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
