// Idle workers run tasks of jobs.

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "server/jobs/workers.h"
#include "tests/server/support/worker_jobs.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr std::chrono::milliseconds kLong{60'000};

TEST(Helpers, RunExactlyOnceForManyJobs) {
  constexpr std::size_t kTasks = 50;
  Workers workers({4, 100});
  std::vector<std::vector<std::atomic<int>>> done(20);
  std::vector<std::thread> threads;
  for (auto& counts : done) {
    counts = std::vector<std::atomic<int>>(kTasks);
    threads.push_back(
        start_job(workers, [&](Workers::Job& own) { own.run(kTasks, [&](std::size_t k) { ++counts[k]; }); }));
  }
  for (auto& thread : threads) thread.join();
  for (const auto& counts : done) {
    for (const auto& count : counts) ASSERT_EQ(count, 1);
  }
}

TEST(Helpers, ReturnAtOnceWhenThereAreNone) {
  Workers workers({2, 0});
  do_job(workers, [&](Workers::Job& own) { own.run(0, [](std::size_t) { FAIL(); }); });
}

TEST(Helpers, RunInOrderOnASingleWorker) {
  Workers workers({1, 0});
  std::vector<std::size_t> done;
  do_job(workers, [&](Workers::Job& own) {
    const auto caller = std::this_thread::get_id();
    own.run(3, [&](std::size_t k) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      done.push_back(k);
    });
  });
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(Helpers, RunOnTheCallerWhenAllOthersAreBusy) {
  Workers workers({2, 1});
  auto busy = admit(workers);
  ASSERT_TRUE(take_turn(*busy));
  int done = 0;
  do_job(workers, [&](Workers::Job& own) {
    const auto caller = std::this_thread::get_id();
    own.run(5, [&](std::size_t) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      ++done;
    });
  });
  EXPECT_EQ(done, 5);
}

/// Tasks that wait for each other, so that they succeed only if all run at the same time.
class Rendezvous {
 public:
  explicit Rendezvous(std::ptrdiff_t tasks) : missing_(tasks) {}
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

TEST(Helpers, RunOnIdleWorkersToo) {
  Workers workers({3, 0});
  for (int round = 0; round < 20; ++round) {
    Rendezvous rendezvous(3);
    do_job(workers,
           [&](Workers::Job& own) { own.run(3, [&](std::size_t) { EXPECT_TRUE(rendezvous.attend()); }); });
  }
}

TEST(Helpers, RunOnAWorkerThatBecomesIdle) {
  Workers workers({2, 0});
  auto busy = admit(workers);
  ASSERT_TRUE(take_turn(*busy));
  std::promise<void> begun;
  Rendezvous rendezvous(2);
  std::thread sharing = start_job(workers, [&](Workers::Job& own) {
    own.run(3, [&](std::size_t k) {
      if (k == 0) begun.set_value();
      if (k < 2) {
        EXPECT_TRUE(rendezvous.attend());
      }
    });
  });
  begun.get_future().wait();
  busy.reset();
  sharing.join();
}

TEST(Helpers, RunOnNoMoreThreadsThanAskedFor) {
  Workers workers({4, 0});
  std::atomic<int> running{0};
  std::atomic<int> most{0};
  do_job(workers, [&](Workers::Job& own) {
    Rendezvous both(2);
    own.run_on(2, 200, [&](std::size_t k) {
      const int now = ++running;
      for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
      }
      if (k < 2) {
        EXPECT_TRUE(both.attend());
      }
      --running;
    });
  });
  EXPECT_EQ(most, 2);
}

TEST(Helpers, DoNotDelayAJobsTurn) {
  Workers workers({2, 0});
  std::atomic<int> begun{0};
  Rendezvous both(2);
  std::promise<void> job_has_turn;
  JobPtr job;
  do_job(workers, [&](Workers::Job& own) {
    const auto caller = std::this_thread::get_id();
    own.run(6, [&](std::size_t) {
      if (const int number = ++begun; number > 2) {
        EXPECT_EQ(std::this_thread::get_id(), caller) << "no worker is idle any more";
        return;
      }
      EXPECT_TRUE(both.attend());
      if (std::this_thread::get_id() == caller) {
        EXPECT_EQ(job_has_turn.get_future().wait_for(kLong), std::future_status::ready);
      } else {
        job = admit(workers);
        EXPECT_TRUE(job && take_turn(*job, within(kLong))) << "a helping worker does not delay the turn";
        job_has_turn.set_value();
      }
    });
  });
  EXPECT_EQ(begun, 6);
}

TEST(Helpers, ThrowTheirExceptionInTheCaller) {
  Workers workers({2, 0});
  do_job(workers, [&](Workers::Job& own) {
    const auto caller = std::this_thread::get_id();
    Rendezvous rendezvous(2);
    EXPECT_THROW(own.run(2,
                         [&](std::size_t) {
                           EXPECT_TRUE(rendezvous.attend());
                           if (std::this_thread::get_id() != caller) throw std::runtime_error("a bug");
                         }),
                 std::runtime_error);
  });
  Rendezvous rendezvous(2);
  do_job(workers,
         [&](Workers::Job& own) { own.run(2, [&](std::size_t) { EXPECT_TRUE(rendezvous.attend()); }); });
}

TEST(Helpers, ThrowOnlyAfterRunningTasksHaveEnded) {
  Workers workers({2, 0});
  do_job(workers, [&](Workers::Job& own) {
    const auto caller = std::this_thread::get_id();
    Rendezvous rendezvous(2);
    bool other_done = false;
    const auto task = [&](std::size_t) {
      EXPECT_TRUE(rendezvous.attend());
      if (std::this_thread::get_id() == caller) throw std::runtime_error("a bug");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the caller has thrown by now
      other_done = true;
    };
    EXPECT_THROW(own.run(2, task), std::runtime_error);
    EXPECT_TRUE(other_done);
  });
}

TEST(Helpers, DoNotStartAfterOneHasThrown) {
  Workers workers({1, 0});
  do_job(workers, [&](Workers::Job& own) {
    std::size_t last = 0;
    const auto task = [&](std::size_t k) {
      last = k;
      if (k == 1) throw std::runtime_error("a bug");
    };
    EXPECT_THROW(own.run(4, task), std::runtime_error);
    EXPECT_EQ(last, 1u);
  });
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
