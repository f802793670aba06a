#include "server/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
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
    threads.reserve(8);
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

void run_as_job(WorkerPool& pool, const WorkerPool::Job& job) {
  const auto ticket = pool.submit(job);
  ASSERT_TRUE(ticket);
  ASSERT_TRUE(pool.wait_for(*ticket, kLong));
}

TEST(WorkerPoolTasks, AreEachDoneOnceForManyJobs) {
  constexpr std::size_t kTasks = 50;
  WorkerPool pool(4, 100);
  std::vector<std::vector<std::atomic<int>>> done(20);
  std::vector<WorkerPool::Ticket> tickets;
  for (auto& counts : done) {
    counts = std::vector<std::atomic<int>>(kTasks);
    const auto ticket = pool.submit([&] { pool.run(kTasks, [&](std::size_t k) { ++counts[k]; }); });
    ASSERT_TRUE(ticket);
    tickets.push_back(*ticket);
  }
  for (const auto& ticket : tickets) ASSERT_TRUE(pool.wait_for(ticket, kLong));
  for (const auto& counts : done) {
    for (const auto& count : counts) ASSERT_EQ(count, 1);
  }
}

TEST(WorkerPoolTasks, OfNoNumberAreDoneAtOnce) {
  WorkerPool pool(2, 0);
  run_as_job(pool, [&] { pool.run(0, [](std::size_t) { FAIL(); }); });
}

TEST(WorkerPoolTasks, AreDoneInOrderByTheOnlyWorker) {
  WorkerPool pool(1, 0);
  std::vector<std::size_t> done;
  run_as_job(pool, [&] {
    const auto caller = std::this_thread::get_id();
    pool.run(3, [&](std::size_t k) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      done.push_back(k);
    });
  });
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(WorkerPoolTasks, AreDoneByTheCallerWhenAllOthersAreBusy) {
  Blocker blocker;
  WorkerPool pool(2, 1);
  ASSERT_TRUE(pool.submit(blocker.job()));
  blocker.await_running();
  int done = 0;
  run_as_job(pool, [&] {
    const auto caller = std::this_thread::get_id();
    pool.run(5, [&](std::size_t) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      ++done;
    });
  });
  EXPECT_EQ(done, 5);
  blocker.release();
}

/// Tasks that wait for each other, so that they end well only if all run at the same time.
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

TEST(WorkerPoolTasks, AreDoneByIdleWorkersToo) {
  WorkerPool pool(3, 0);
  for (int round = 0; round < 20; ++round) {
    Meeting meeting(3);
    run_as_job(pool, [&] { pool.run(3, [&](std::size_t) { EXPECT_TRUE(meeting.attend()); }); });
  }
}

TEST(WorkerPoolTasks, AreLeftToOthersWhenAJobWaits) {
  WorkerPool pool(2, 0);
  std::atomic<int> begun{0};
  int begun_before_job = 0;
  std::promise<void> job_done;
  run_as_job(pool, [&] {
    const auto caller = std::this_thread::get_id();
    Meeting meeting(2);
    pool.run(6, [&](std::size_t) {
      const int number = ++begun;
      if (number > 2) return;
      EXPECT_TRUE(meeting.attend());
      if (std::this_thread::get_id() == caller) {
        EXPECT_EQ(job_done.get_future().wait_for(kLong), std::future_status::ready);
      } else {
        EXPECT_TRUE(pool.submit([&] {
          begun_before_job = begun;
          job_done.set_value();
        }));
      }
    });
  });
  EXPECT_EQ(begun_before_job, 2) << "the helper goes from the task at hand to the job";
  EXPECT_EQ(begun, 6);
}

TEST(WorkerPoolTasks, OccupyNoPlaceOfAJob) {
  Blocker by_one;
  Blocker by_other;
  WorkerPool pool(2, 0);
  const auto sharing =
      pool.submit([&] { pool.run(2, [&](std::size_t k) { k == 0 ? by_one.job()() : by_other.job()(); }); });
  by_one.await_running();
  by_other.await_running();
  const auto taken = pool.submit([] {});
  EXPECT_TRUE(taken) << "the worker that helps is about to be idle";
  EXPECT_FALSE(pool.submit([] {}));
  by_one.release();
  by_other.release();
  EXPECT_TRUE(pool.wait_for(*sharing, kLong));
  EXPECT_TRUE(pool.wait_for(*taken, kLong));
}

TEST(WorkerPoolTasks, AreAllDoneWhenThePoolEndsMeanwhile) {
  std::atomic<int> done{0};
  std::promise<void> met;
  auto pool = std::make_unique<WorkerPool>(2, 1);
  WorkerPool& tasks_pool = *pool;
  ASSERT_TRUE(pool->submit([&] {
    Meeting meeting(2);
    std::atomic<int> begun{0};
    tasks_pool.run(8, [&](std::size_t) {
      if (const int number = ++begun; number <= 2) {
        EXPECT_TRUE(meeting.attend());
        if (number == 2) met.set_value();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the pool ends now
      ++done;
    });
  }));
  met.get_future().wait();
  pool.reset();
  EXPECT_EQ(done, 8);
}

TEST(WorkerPoolTasks, ThrowTheirExceptionAtTheCaller) {
  WorkerPool pool(2, 0);
  run_as_job(pool, [&] {
    const auto caller = std::this_thread::get_id();
    Meeting meeting(2);
    EXPECT_THROW(pool.run(2,
                          [&](std::size_t) {
                            EXPECT_TRUE(meeting.attend());
                            if (std::this_thread::get_id() != caller) throw std::runtime_error("a bug");
                          }),
                 std::runtime_error);
  });
  Meeting meeting(2);
  run_as_job(pool, [&] { pool.run(2, [&](std::size_t) { EXPECT_TRUE(meeting.attend()); }); });
}

TEST(WorkerPoolTasks, ThrowOnlyWhenNoneRunsAnyMore) {
  WorkerPool pool(2, 0);
  run_as_job(pool, [&] {
    const auto caller = std::this_thread::get_id();
    Meeting meeting(2);
    bool other_done = false;
    const auto task = [&](std::size_t) {
      EXPECT_TRUE(meeting.attend());
      if (std::this_thread::get_id() == caller) throw std::runtime_error("a bug");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the caller has thrown by now
      other_done = true;
    };
    EXPECT_THROW(pool.run(2, task), std::runtime_error);
    EXPECT_TRUE(other_done);
  });
}

TEST(WorkerPoolTasks, AreNotBegunAfterOneHasThrown) {
  WorkerPool pool(1, 0);
  run_as_job(pool, [&] {
    std::size_t last = 0;
    const auto task = [&](std::size_t k) {
      last = k;
      if (k == 1) throw std::runtime_error("a bug");
    };
    EXPECT_THROW(pool.run(4, task), std::runtime_error);
    EXPECT_EQ(last, 1u);
  });
}

}  // namespace
}  // namespace fleetplan::server
