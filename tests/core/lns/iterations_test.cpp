#include "core/lns/iterations.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

/// How often each alternative is chosen in 1000 tries with these gains and efforts.
std::vector<int> tries(AdaptiveChoice& choice, const std::vector<double>& gain,
                       const std::vector<double>& effort) {
  Random random(1);
  std::vector<int> tries(gain.size(), 0);
  for (int k = 0; k < 1000; ++k) {
    const std::size_t alternative = choice.choose(random);
    ++tries[alternative];
    choice.learn(alternative, gain[alternative], effort[alternative]);
  }
  return tries;
}

TEST(AdaptiveChoice, ChoosesUniformlyBeforeTheFirstTry) {
  const AdaptiveChoice choice(3);
  Random random(7);
  std::vector<int> chosen(3, 0);
  for (int k = 0; k < 300; ++k) ++chosen[choice.choose(random)];
  for (const int count : chosen) EXPECT_GT(count, 60);
}

TEST(AdaptiveChoice, PrefersHigherGainsWithoutExcludingLowerOnes) {
  AdaptiveChoice choice(2);
  const auto chosen = tries(choice, {1.0, 5.0}, {1.0, 1.0});
  EXPECT_GT(chosen[1], 3 * chosen[0]);
  EXPECT_GT(chosen[0], 30);
}

TEST(AdaptiveChoice, PrefersLessEffort) {
  AdaptiveChoice choice(2);
  const auto chosen = tries(choice, {1.0, 1.0}, {1.0, 10.0});
  EXPECT_GT(chosen[0], 20 * chosen[1]);
  EXPECT_GT(chosen[1], 0);
}

TEST(AdaptiveChoice, SpendsEqualEffortWithoutGains) {
  AdaptiveChoice choice(2);
  const auto chosen = tries(choice, {0.0, 0.0}, {1.0, 10.0});
  EXPECT_NEAR(chosen[0] / 10.0, chosen[1], 35.0);
}

TEST(AdaptiveChoice, AdaptsToChangedGains) {
  AdaptiveChoice choice(2);
  tries(choice, {5.0, 1.0}, {1.0, 1.0});
  const auto chosen = tries(choice, {1.0, 5.0}, {1.0, 1.0});
  EXPECT_GT(chosen[1], 2 * chosen[0]);
}

TEST(AdaptiveChoice, ChoosesAmongTheFirstAlternatives) {
  AdaptiveChoice choice(3);
  tries(choice, {1.0, 1.0, 50.0}, {1.0, 1.0, 1.0});
  Random random(1);
  std::vector<int> chosen(3, 0);
  for (int k = 0; k < 300; ++k) ++chosen[choice.choose(random, 2)];
  EXPECT_GT(chosen[0], 100);
  EXPECT_GT(chosen[1], 100);
  EXPECT_EQ(chosen[2], 0);
}

/// How often each robot is chosen in 1000 draws.
std::map<std::size_t, int> chosen(const DelayedChoice& choice, const std::vector<std::size_t>& robots,
                                  const std::vector<double>& delays) {
  Random random(3);
  std::map<std::size_t, int> chosen;
  for (int k = 0; k < 1000; ++k) ++chosen[choice.choose(robots, delays, random)];
  return chosen;
}

TEST(DelayedChoice, ChoosesInProportionToDelay) {
  const DelayedChoice choice(8);
  auto times = chosen(choice, {2, 5, 7}, {1.0, 0.0, 3.0});
  EXPECT_NEAR(times[2], 250, 60);
  EXPECT_EQ(times[5], 0);
  EXPECT_NEAR(times[7], 750, 60);
}

TEST(DelayedChoice, PrefersRobotsWithFewerFailures) {
  DelayedChoice choice(2);
  choice.learn(1, false);
  choice.learn(1, false);
  choice.learn(1, false);
  EXPECT_NEAR(chosen(choice, {0, 1}, {1.0, 1.0})[1], 200, 60);
}

TEST(DelayedChoice, ReducesFailuresAfterAGain) {
  DelayedChoice choice(2);
  for (int k = 0; k < 8; ++k) choice.learn(0, false);
  const int before = chosen(choice, {0, 1}, {1.0, 1.0})[0];
  choice.learn(0, true);
  EXPECT_GT(chosen(choice, {0, 1}, {1.0, 1.0})[0], before + 20);
}

TEST(DelayedChoice, ChoosesARobotWithoutDelays) {
  EXPECT_EQ(chosen(DelayedChoice(4), {1, 3}, {0.0, 0.0})[3], 1000);
}

/// Two robots that set out 10 s late.
struct LateRobots : Planning {
  static Trajectory row(double y, double departure) { return through({{0.5, y}, {8.5, y}}, departure); }

  LateRobots()
      : Planning(OccupancyGrid(9, 9, 1.0),
                 {support::robot_at(0.5, 2.5).to(8.5, 2.5), support::robot_at(0.5, 6.5).to(8.5, 6.5)}) {
    reservations.follow(0, row(2.5, 10.0));
    reservations.follow(1, row(6.5, 10.0));
  }
};

struct IterationsOfLateRobots : LateRobots {
  /// Completes so many iterations with a search, without a change. Iterations between them only smooth.
  void in_vain(int count) {
    while (count > 0) {
      Iteration iteration = iterations.choose();
      if (iteration.options.settings) --count;
      EXPECT_FALSE(iterations.accept(iteration, *workspace));
    }
  }
  Iteration choose_search() {
    Iteration iteration = iterations.choose();
    while (!iteration.options.settings) iteration = iterations.choose();
    return iteration;
  }
  double max_loss() { return iterations.choose().options.max_loss; }
  /// Completes an iteration that lets robot 0 set out at `departure`.
  bool let_depart(double departure) { return complete(choose_search(), departure); }
  bool complete(Iteration iteration, double departure) {
    Trajectory changed = row(2.5, departure);
    const double gain = incumbent.cost(0) - changed.cost;
    iteration.result.change = Change{{{0, std::move(changed)}}, gain};
    return iterations.accept(iteration, *workspace);
  }

  Incumbent incumbent{state, movers()};
  TautPathBounds bounds{instance, movers(), std::vector<double>(instance.size(), kForever), never};
  Exhaustion exhaustion{incumbent, bounds, false};
  Iterations iterations{incumbent, exhaustion, bounds, random, never, false};
  WorkspacePool pool{state, incumbent, never};
  std::unique_ptr<Workspace> workspace = pool.take();
};

TEST(Iterations, StrayFartherTheLongerTheyAreInVain) {
  IterationsOfLateRobots p;
  const double least = p.max_loss();
  EXPECT_GT(least, 0.0);
  p.in_vain(8);
  EXPECT_EQ(p.max_loss(), least) << "four for each robot";
  p.in_vain(2);
  EXPECT_DOUBLE_EQ(p.max_loss(), 2.0 * least) << "one more for each";
  p.in_vain(4);
  EXPECT_DOUBLE_EQ(p.max_loss(), 8.0 * least);
  EXPECT_TRUE(p.let_depart(9.0));
  EXPECT_LE(p.max_loss(), least) << "a better plan";
}

TEST(Iterations, ReturnToTheBestPlanAfterTheyHaveStrayed) {
  IterationsOfLateRobots p;
  const double least = p.max_loss();
  p.in_vain(20);
  EXPECT_FALSE(p.let_depart(60.0));
  EXPECT_EQ(p.incumbent.cost(0), LateRobots::row(2.5, 60.0).cost);
  p.in_vain(2);
  EXPECT_EQ(p.incumbent.cost(0), LateRobots::row(2.5, 60.0).cost);
  p.in_vain(1);
  EXPECT_EQ(p.incumbent.cost(0), LateRobots::row(2.5, 10.0).cost) << "as at first";
  EXPECT_DOUBLE_EQ(p.max_loss(), least);
  EXPECT_EQ(p.iterations.vain(), 24) << "since the best plan was found";
  p.in_vain(2);
  EXPECT_DOUBLE_EQ(p.max_loss(), 2.0 * least) << "they stray again at once";
}

TEST(Iterations, SmoothWithoutASearchOnceSearchesAreInVain) {
  IterationsOfLateRobots p;
  const auto smoothed = [&] {
    int count = 0;
    for (int k = 0; k < 200; ++k) count += p.iterations.choose().options.settings ? 0 : 1;
    return count;
  };
  EXPECT_EQ(smoothed(), 0);
  const int tries_at_first = p.iterations.choose().options.tries;
  p.in_vain(2);
  EXPECT_GT(smoothed(), 20);
  EXPECT_GT(p.choose_search().options.tries, tries_at_first);
}

TEST(Iterations, SmoothOneRobotAfterTheOtherUntilNoneGains) {
  IterationsOfLateRobots p;
  Iteration earlier = p.choose_search();
  EXPECT_FALSE(p.let_depart(10.1)) << "worse";
  EXPECT_EQ(p.incumbent.cost(0), LateRobots::row(2.5, 10.1).cost);
  p.iterations.begin_smoothing();
  EXPECT_EQ(p.incumbent.cost(0), LateRobots::row(2.5, 10.0).cost) << "of the best plan";
  EXPECT_FALSE(p.complete(std::move(earlier), 10.1));
  EXPECT_EQ(p.incumbent.cost(0), LateRobots::row(2.5, 10.0).cost) << "no worse one is accepted";
  const auto smooth_next = [&](std::optional<double> departure) {
    Iteration iteration = p.iterations.choose();
    EXPECT_FALSE(iteration.options.settings);
    if (departure) {
      Trajectory changed = LateRobots::row(2.5, *departure);
      const double gain = p.incumbent.cost(0) - changed.cost;
      iteration.result.change = Change{{{0, std::move(changed)}}, gain};
    }
    p.iterations.accept(iteration, *p.workspace);
    return iteration.first;
  };
  const auto searches_again = [&] {
    int searches = 0;
    for (int k = 0; k < 50; ++k) searches += p.iterations.choose().options.settings ? 1 : 0;
    return searches > 0;
  };
  EXPECT_EQ(smooth_next(std::nullopt), 0U);
  EXPECT_EQ(smooth_next(std::nullopt), 1U);
  EXPECT_TRUE(searches_again()) << "both in vain";
  p.iterations.begin_smoothing();
  EXPECT_EQ(smooth_next(9.0), 0U);
  EXPECT_EQ(smooth_next(std::nullopt), 1U);
  EXPECT_EQ(smooth_next(std::nullopt), 0U) << "has gained";
  EXPECT_TRUE(searches_again());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
