#include "core/reservation/segment_index.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/runtime/memory_account.h"
#include "tests/core/support/disks.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Robots = std::vector<std::size_t>;

constexpr double kRadius = 0.3;  // metres, of robots that are not large
constexpr std::int64_t kMiB = 1 << 20;

std::vector<SizedSegment> rest(const Position& at, double t_begin, double t_end, double radius = kRadius) {
  return {{{{at, at}, t_begin, t_end}, radius}};
}

/// The robots that `robot` meets at a place at any time, in order.
Robots met_at(const SegmentIndex& index, std::size_t robot, const Position& place) {
  Robots met;
  for (const SegmentIndex::Layer& layer : index.layers(robot)) {
    index.visit(layer, layer.grid().at(place), 0.0, kForever, [&](const SegmentIndex::Occupant& other) {
      met.push_back(other.robot);
      return true;
    });
  }
  return met;
}

TEST(SegmentIndex, VisitsEqualBeginningsInTheOrderInWhichTheyWereAdded) {
  for (const double t_end : {3.0, kForever}) {
    SegmentIndex index(20.0, 20.0, 1.0, disks_of(std::vector<double>(40, kRadius)), nullptr);
    Robots expected;
    for (std::size_t robot = 1; robot < 40; ++robot) {
      index.add(robot, rest({5.5, 5.5}, 1.0, t_end));
      expected.push_back(robot);
    }
    for (const std::size_t robot : {7, 1, 39, 20}) {
      index.remove(robot);
      std::erase(expected, robot);
    }
    for (const std::size_t robot : {20, 7}) {  // their segments take the place of others
      index.add(robot, rest({5.5, 5.5}, 1.0, t_end));
      expected.push_back(robot);
    }
    EXPECT_EQ(met_at(index, 0, {5.5, 5.5}), expected);
    for (const std::size_t robot : Robots(expected)) {
      index.remove(robot);
      std::erase(expected, robot);
      EXPECT_EQ(met_at(index, 0, {5.5, 5.5}), expected);
    }
  }
}

/// Many robots and a large one, which come near to each other in thousands of buckets of the size for the
/// many.
class OneLargeRobot : public testing::Test {
 protected:
  static constexpr std::size_t kCount = 2000;
  static constexpr std::size_t kLarge = 0;
  static constexpr double kLargeRadius = 50.0;

  static std::vector<double> radii() {
    std::vector<double> all(kCount, kRadius);
    all[kLarge] = kLargeRadius;
    return all;
  }
  static Position place(std::size_t robot) {
    return {0.5 + static_cast<double>(robot % 45), 0.5 + static_cast<double>(robot / 45)};
  }

  SegmentIndex index{400.0, 400.0, 1.0, disks_of(radii()), nullptr};
};

TEST_F(OneLargeRobot, MakesEveryRobotBeInFewBuckets) {
  MemoryAccount account(1024 * kMiB);
  const MemoryScope scope(&account);
  for (std::size_t robot = 1; robot < kCount; ++robot) index.add(robot, rest(place(robot), 0.0, 3.0));
  EXPECT_LT(account.used(), 32 * kMiB) << "the entries of buckets";
  const std::int64_t before = account.used();
  for (int k = 0; k < 300; ++k) index.add(kLarge, rest({348.5, 348.5}, k, k + 1.0, kLargeRadius));
  EXPECT_LT(account.used() - before, 32 * kMiB) << "the entries of buckets";
}

TEST_F(OneLargeRobot, MeetsOthersAndIsMetByThem) {
  index.add(1, rest({10.5, 10.5}, 0.0, 3.0));
  index.add(2, rest({300.5, 10.5}, 0.0, kForever));
  index.add(kLarge, rest({200.5, 200.5}, 0.0, kForever, kLargeRadius));
  EXPECT_EQ(met_at(index, kLarge, {60.5, 10.5}), Robots{1});
  EXPECT_EQ(met_at(index, kLarge, {250.5, 10.5}), Robots{2});
  EXPECT_EQ(met_at(index, kLarge, {100.5, 300.5}), Robots{});
  EXPECT_EQ(met_at(index, 3, {200.5, 250.5}), Robots{kLarge});
  EXPECT_EQ(met_at(index, 3, {10.5, 10.5}), Robots{1});
  EXPECT_EQ(met_at(index, 3, {60.5, 10.5}), Robots{});
  for (const std::size_t robot : {std::size_t{1}, std::size_t{2}, kLarge}) index.remove(robot);
  EXPECT_EQ(met_at(index, kLarge, {60.5, 10.5}), Robots{});
  EXPECT_EQ(met_at(index, 3, {200.5, 250.5}), Robots{});
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
