#include "core/runtime/arrays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

TEST(RadixHeap, TakesTheLeastKeyFirst) {
  RadixHeap<int> heap;
  EXPECT_TRUE(heap.empty());
  for (const auto& [key, item] : {std::pair(2.5F, 3), {0.0F, 1}, {7e8F, 4}, {1e-20F, 2}})
    heap.push(key, item);
  for (const int item : {1, 2, 3, 4}) EXPECT_EQ(heap.pop(), item);
  EXPECT_TRUE(heap.empty());
}

TEST(RadixHeap, AgreesWithABinaryHeapWhereKeysGrow) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    support::Dice dice(seed);
    RadixHeap<float> heap;
    std::priority_queue<float, std::vector<float>, std::greater<>> expected;
    float last = 0.0F;
    for (int step = 0; step < 2000; ++step) {
      if (expected.empty() || dice.below(5) < 3) {
        const float key = last + static_cast<float>(dice.below(1000)) / 16.0F;
        heap.push(key, key);
        expected.push(key);
      } else {
        last = heap.pop();
        ASSERT_EQ(last, expected.top()) << "seed " << seed << ", step " << step;
        expected.pop();
      }
      ASSERT_EQ(heap.empty(), expected.empty());
    }
  }
}

TEST(RadixHeap, TakesAKeyThatIsTooSmallNext) {
  RadixHeap<int> heap;
  heap.push(5.0F, 1);
  heap.push(6.0F, 2);
  EXPECT_EQ(heap.pop(), 1);
  heap.push(4.0F, 3);
  EXPECT_EQ(heap.pop(), 3);
  EXPECT_EQ(heap.pop(), 2);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
