#include "core/lns/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fleetplan::core {
namespace TEST_FILE {

struct Step {
  int number = 0;
  int completed_before = 0;  // when it began
};

/// Begins `count` steps, numbered from 0, on some threads, and completes all.
class Sequence {
 public:
  Sequence(std::size_t lag, int count) : pipeline_(lag), count_(count) {}

  void run(int threads) {
    {
      std::vector<std::jthread> all;
      for (int t = 0; t < threads; ++t) {
        all.emplace_back([&] {
          while (run_step()) {
          }
        });
      }
    }
    pipeline_.complete_all([&](Step& step) { completed.push_back(step); });
  }

  std::vector<Step> completed;

 private:
  bool run_step() {
    const auto running = pipeline_.begin([&](Step& step) { completed.push_back(step); },
                                         [&]() -> std::optional<Step> {
                                           if (begun_ == count_) return std::nullopt;
                                           return Step{begun_++, static_cast<int>(completed.size())};
                                         });
    if (!running) return false;
    if ((*running).number % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    return true;
  }

  Pipeline<Step> pipeline_;
  const int count_;
  int begun_ = 0;
};

TEST(Pipeline, CompletesStepsInOrderAfterTheSameStepsForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 4}) {
    SCOPED_TRACE(threads);
    Sequence sequence(3, 100);
    sequence.run(threads);
    ASSERT_EQ(sequence.completed.size(), 100U);
    for (int k = 0; k < 100; ++k) {
      const Step& step = sequence.completed[static_cast<std::size_t>(k)];
      ASSERT_EQ(step.number, k);
      ASSERT_EQ(step.completed_before, std::max(0, k - 2)) << "those up to k - 3";
    }
  }
}

TEST(Pipeline, RunsStepsWhileAnEarlierOneRuns) {
  Pipeline<int> pipeline(3);
  int number = 0;
  std::vector<int> completed;
  const auto complete = [&](int step) { completed.push_back(step); };
  const auto next = [&] { return std::optional(number++); };
  {
    const auto first = pipeline.begin(complete, next);
    for (const int later : {1, 2}) {
      const auto running = pipeline.begin(complete, next);
      EXPECT_EQ(*running, later);
    }
    EXPECT_EQ(completed, std::vector<int>{});
  }
  const auto after = pipeline.begin(complete, next);
  EXPECT_EQ(completed, std::vector{0});
}

TEST(Pipeline, GoesOnAfterAnException) {
  Pipeline<int> pipeline(1);
  const auto fail = [](int) { throw std::runtime_error("not completed"); };
  std::vector<int> completed;
  const auto complete = [&](int step) { completed.push_back(step); };
  const auto none = []() -> std::optional<int> { throw std::runtime_error("no step"); };
  EXPECT_THROW(pipeline.begin(complete, none), std::runtime_error);
  EXPECT_TRUE(pipeline.begin(complete, [] { return std::optional(5); })) << "the first step";
  EXPECT_THROW(pipeline.begin(fail, [] { return std::optional(6); }), std::runtime_error);
  EXPECT_FALSE(pipeline.begin(complete, [] { return std::optional<int>(); }));
  EXPECT_EQ(completed, std::vector{5});
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
