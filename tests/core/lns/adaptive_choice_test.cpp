#include "core/lns/adaptive_choice.h"

#include <gtest/gtest.h>

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

}  // namespace TEST_FILE
}  // namespace fleetplan::core
