#include "server/jobs/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <future>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace fleetplan::server {
namespace {

constexpr std::chrono::milliseconds kLong{60'000};

const core::StopCondition kForever;

core::StopCondition within(std::chrono::milliseconds time) {
  return core::StopCondition(Workers::Clock::now() + time);
}

/// Does a job from admission to end, in its own thread.
template <class Work>
std::thread start_job(Workers& workers, Work work) {
  return std::thread([&workers, work] {
    auto job = workers.admit();
    ASSERT_TRUE(job);
    ASSERT_TRUE(job->await_turn(kForever));
    work();
  });
}

/// Does a job from admission to end, in the calling thread.
template <class Work>
void do_job(Workers& workers, Work work) {
  auto job = workers.admit();
  ASSERT_TRUE(job);
  ASSERT_TRUE(job->await_turn(kForever));
  work();
}

TEST(Workers, RunAtMostOneJobPerWorker) {
  Workers workers(3, 1000);
  std::atomic<int> computing{0};
  std::atomic<int> done{0};
  std::vector<std::thread> threads;
  threads.reserve(8);
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        do_job(workers, [&] {
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
  EXPECT_EQ(workers.running(), 0u);
  EXPECT_EQ(workers.queued(), 0u);
}

TEST(Workers, RejectAJobBeyondTheQueue) {
  Workers workers(1, 2);
  auto running = workers.admit();
  auto second = workers.admit();
  auto third = workers.admit();
  ASSERT_TRUE(running && second && third);
  EXPECT_FALSE(workers.admit());
  EXPECT_GE(workers.retry_after_s(), 1);
  second.reset();
  EXPECT_TRUE(workers.admit()) << "a job that ends frees its place, even if its turn never came";
}

TEST(Workers, RejectABurstWhileJobsAreLong) {
  Workers workers(1, 1, 100);
  auto running = workers.admit();
  ASSERT_TRUE(running->await_turn(kForever));
  const auto waiting = workers.admit();
  EXPECT_TRUE(waiting);
  std::this_thread::sleep_for(Workers::kShortWait);
  EXPECT_FALSE(workers.admit()) << "the running job has taken longer than a short wait";
}

TEST(Workers, AcceptABurstOfShortJobsBesideALongOne) {
  Workers workers(2, 1, 100);
  do_job(workers, [] {});
  auto long_one = workers.admit();
  ASSERT_TRUE(long_one->await_turn(kForever));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::vector<Workers::Job> jobs;
  for (int k = 0; k < 50; ++k) {
    auto job = workers.admit();
    ASSERT_TRUE(job) << "no job that has ended was long";
    jobs.push_back(std::move(*job));
  }
}

TEST(Workers, LimitABurstHoweverShortTheJobs) {
  Workers workers(1, 1, 3);
  std::vector<Workers::Job> jobs;
  while (auto job = workers.admit()) jobs.push_back(std::move(*job));
  EXPECT_EQ(jobs.size(), 1u + 1u + 3u);
}

TEST(Workers, AcceptOneJobEachWithoutAQueue) {
  Workers workers(2, 0);
  const auto one = workers.admit();
  const auto other = workers.admit();
  EXPECT_TRUE(one && other);
  EXPECT_FALSE(workers.admit());
}

TEST(Workers, GiveTurnsInOrder) {
  Workers workers(1, 10);
  auto first = workers.admit();
  ASSERT_TRUE(first->await_turn(kForever));
  std::vector<int> order;  // one job at a time writes to it
  std::vector<std::thread> threads;
  for (int k = 0; k < 5; ++k) {
    threads.push_back(start_job(workers, [&order, k] { order.push_back(k); }));
    while (workers.queued() != static_cast<std::size_t>(k) + 1) std::this_thread::yield();
  }
  first.reset();
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(Workers, StopWaitingWhenTheJobsStopConditionIsMet) {
  Workers workers(1, 10);
  auto running = workers.admit();
  ASSERT_TRUE(running->await_turn(kForever));
  auto late = workers.admit();
  EXPECT_FALSE(late->await_turn(within(std::chrono::milliseconds(5))));
  auto left = workers.admit();
  std::stop_source stop;
  std::jthread leaver([&] {
    while (workers.queued() == 0) std::this_thread::yield();
    stop.request_stop();
  });
  EXPECT_FALSE(left->await_turn(core::StopCondition(Workers::Clock::time_point::max(), stop.get_token())));
  EXPECT_EQ(workers.queued(), 0u);
  running.reset();
  auto next = workers.admit();
  EXPECT_TRUE(next->await_turn(kForever)) << "jobs that stopped waiting get no turn";
}

TEST(WorkersTasks, RunExactlyOnceForManyJobs) {
  constexpr std::size_t kTasks = 50;
  Workers workers(4, 100);
  std::vector<std::vector<std::atomic<int>>> done(20);
  std::vector<std::thread> threads;
  for (auto& counts : done) {
    counts = std::vector<std::atomic<int>>(kTasks);
    threads.push_back(start_job(workers, [&] { workers.run(kTasks, [&](std::size_t k) { ++counts[k]; }); }));
  }
  for (auto& thread : threads) thread.join();
  for (const auto& counts : done) {
    for (const auto& count : counts) ASSERT_EQ(count, 1);
  }
}

TEST(WorkersTasks, ReturnAtOnceWhenThereAreNone) {
  Workers workers(2, 0);
  do_job(workers, [&] { workers.run(0, [](std::size_t) { FAIL(); }); });
}

TEST(WorkersTasks, RunInOrderOnASingleWorker) {
  Workers workers(1, 0);
  std::vector<std::size_t> done;
  do_job(workers, [&] {
    const auto caller = std::this_thread::get_id();
    workers.run(3, [&](std::size_t k) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      done.push_back(k);
    });
  });
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(WorkersTasks, RunOnTheCallerWhenAllOthersAreBusy) {
  Workers workers(2, 1);
  auto busy = workers.admit();
  ASSERT_TRUE(busy->await_turn(kForever));
  int done = 0;
  do_job(workers, [&] {
    const auto caller = std::this_thread::get_id();
    workers.run(5, [&](std::size_t) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      ++done;
    });
  });
  EXPECT_EQ(done, 5);
}

/// Tasks that wait for each other, so that they succeed only if all run at the same time.
class Meeting {
 public:
  explicit Meeting(std::ptrdiff_t tasks) : missing_(tasks) {}
  bool attend() {
    std::unique_lock lock(mutex_);
    if (--missing_ == 0) complete_.notify_all();
    return complete_.wait_for(lock, kLong, [&] { return missing_ <= 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable complete_;
  std::ptrdiff_t missing_;
};

TEST(WorkersTasks, RunOnIdleWorkersToo) {
  Workers workers(3, 0);
  for (int round = 0; round < 20; ++round) {
    Meeting meeting(3);
    do_job(workers, [&] { workers.run(3, [&](std::size_t) { EXPECT_TRUE(meeting.attend()); }); });
  }
}

TEST(WorkersTasks, RunOnAWorkerThatBecomesIdle) {
  Workers workers(2, 0);
  auto busy = workers.admit();
  ASSERT_TRUE(busy->await_turn(kForever));
  std::promise<void> begun;
  Meeting meeting(2);
  std::thread sharing = start_job(workers, [&] {
    workers.run(3, [&](std::size_t k) {
      if (k == 0) begun.set_value();
      if (k < 2) {
        EXPECT_TRUE(meeting.attend());
      }
    });
  });
  begun.get_future().wait();
  busy.reset();
  sharing.join();
}

TEST(WorkersTasks, DoNotDelayAJobsTurn) {
  Workers workers(2, 0);
  std::atomic<int> begun{0};
  Meeting both(2);
  std::promise<void> job_has_turn;
  std::optional<Workers::Job> job;
  do_job(workers, [&] {
    const auto caller = std::this_thread::get_id();
    workers.run(6, [&](std::size_t) {
      if (const int number = ++begun; number > 2) {
        EXPECT_EQ(std::this_thread::get_id(), caller) << "no worker is idle any more";
        return;
      }
      EXPECT_TRUE(both.attend());
      if (std::this_thread::get_id() == caller) {
        EXPECT_EQ(job_has_turn.get_future().wait_for(kLong), std::future_status::ready);
      } else {
        if (auto admitted = workers.admit()) job.emplace(std::move(*admitted));
        EXPECT_TRUE(job && job->await_turn(within(kLong))) << "a helping worker does not delay the turn";
        job_has_turn.set_value();
      }
    });
  });
  EXPECT_EQ(begun, 6);
}

TEST(WorkersTasks, ThrowTheirExceptionInTheCaller) {
  Workers workers(2, 0);
  do_job(workers, [&] {
    const auto caller = std::this_thread::get_id();
    Meeting meeting(2);
    EXPECT_THROW(workers.run(2,
                             [&](std::size_t) {
                               EXPECT_TRUE(meeting.attend());
                               if (std::this_thread::get_id() != caller) throw std::runtime_error("a bug");
                             }),
                 std::runtime_error);
  });
  Meeting meeting(2);
  do_job(workers, [&] { workers.run(2, [&](std::size_t) { EXPECT_TRUE(meeting.attend()); }); });
}

TEST(WorkersTasks, ThrowOnlyAfterRunningTasksHaveEnded) {
  Workers workers(2, 0);
  do_job(workers, [&] {
    const auto caller = std::this_thread::get_id();
    Meeting meeting(2);
    bool other_done = false;
    const auto task = [&](std::size_t) {
      EXPECT_TRUE(meeting.attend());
      if (std::this_thread::get_id() == caller) throw std::runtime_error("a bug");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the caller has thrown by now
      other_done = true;
    };
    EXPECT_THROW(workers.run(2, task), std::runtime_error);
    EXPECT_TRUE(other_done);
  });
}

TEST(WorkersTasks, DoNotStartAfterOneHasThrown) {
  Workers workers(1, 0);
  do_job(workers, [&] {
    std::size_t last = 0;
    const auto task = [&](std::size_t k) {
      last = k;
      if (k == 1) throw std::runtime_error("a bug");
    };
    EXPECT_THROW(workers.run(4, task), std::runtime_error);
    EXPECT_EQ(last, 1u);
  });
}

}  // namespace
}  // namespace fleetplan::server
