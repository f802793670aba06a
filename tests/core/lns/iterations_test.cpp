#include "core/lns/iterations.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

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

}  // namespace TEST_FILE
}  // namespace fleetplan::core
