#include "core/runtime/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace fleetplan::core {
namespace TEST_FILE {

TEST(Random, IsTheSameOnEveryMachine) {
  Random random(5489);  // the seed for which the standard names mt19937_64's values
  for (int i = 1; i < 10000; ++i) random.below(2);
  EXPECT_EQ(random.below(std::size_t{1} << 32), 9981545732273789042ull % (1ull << 32));
}

TEST(Random, StaysWithinItsRange) {
  Random random(1);
  std::vector<int> counts(5, 0);
  for (int i = 0; i < 5000; ++i) ++counts.at(random.below(5));
  for (const int count : counts) EXPECT_GT(count, 800);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.unit();
    EXPECT_GE(value, 0.0);
    EXPECT_LT(value, 1.0);
  }
  EXPECT_EQ(random.below(1), 0u);
}

TEST(Random, ShufflesIntoEveryOrder) {
  Random random(2);
  std::vector<std::vector<int>> seen;
  for (int i = 0; i < 500; ++i) {
    std::vector<int> items{1, 2, 3};
    random.shuffle(items);
    if (std::find(seen.begin(), seen.end(), items) == seen.end()) seen.push_back(items);
  }
  EXPECT_EQ(seen.size(), 6u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
