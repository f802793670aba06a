#include "tests/bench/alone.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/bench/instance.h"
#include "tests/bench/measure.h"

namespace fleetplan::bench {
namespace TEST_FILE {

using nlohmann::json;

TEST(Alone, IsMeasuredBesideThePlanIfAskedFor) {
  const Instance instance = make_instance("small", generate(hall("empty", 12, 3), 1));
  const std::string body = instance.body(3, {{"time_budget_ms", 10'000}});
  EXPECT_FALSE(measure("small", 3, body, {10.0, 1, false}).alone);
  const Measurement both = measure("small", 3, body, {10.0, 3, true});
  ASSERT_TRUE(both.alone);
  EXPECT_GT(both.alone->seconds, 0.0);
}

TEST(Alone, ReportsTheShareOfTheFloorThatTheDisksCover) {
  const Instance instance = make_instance("small", generate(hall("empty", 12, 3), 1));
  const double disks = std::numbers::pi * (0.3 * 0.3 + 0.5 * 0.5 + 1.0 * 1.0);
  EXPECT_NEAR(plan_alone(instance.body(3, json::object()), {}, 1).floor_share, disks / 144.0, 1e-12);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
