#include "tests/bench/lifelong/warehouse.h"

#include <gtest/gtest.h>

#include "core/map/line_of_sight.h"
#include "tests/bench/instance.h"
#include "tests/bench/lifelong/fleet.h"
#include "tests/bench/lifelong/fleet_request.h"

namespace fleetplan::bench {
namespace TEST_FILE {

using nlohmann::json;

TEST(Warehouse, IsThatOfTheExamples) {
  const Instance example = read_instance("warehouse", FLEETPLAN_SCENARIOS "/warehouse.json");
  EXPECT_EQ(map_json(warehouse_map({})), json::parse(example.body(1, json::object())).at("map"));
}

TEST(Warehouse, MayBeLarger) {
  const core::OccupancyGrid grid = warehouse_map({10, 20});
  EXPECT_EQ(grid.columns(), 203);
  EXPECT_EQ(grid.rows(), 104);
}

TEST(Warehouse, HasPlacesInFrontOfEveryShelfWhereARobotFits) {
  const core::LineOfSight sight(warehouse_map({}), core::StopCondition::never());
  for (const double radius : {0.2, 0.3}) {
    const auto places = shelf_places({}, radius);
    EXPECT_EQ(places.size(), 3u * 8u * 16u * 2u);
    for (const core::Pose& place : places) {
      ASSERT_TRUE(sight.disk_fits(place.position, radius)) << place.position.transpose();
      ASSERT_FALSE(sight.disk_fits(place.position, radius + 0.06)) << place.position.transpose();
    }
  }
}

TEST(Fleet, HasGoalsThatDoNotOverlap) {
  Fleet fleet({}, 80, 3);
  for (Vehicle& vehicle : fleet.vehicles()) {
    const core::Pose last = vehicle.goal;
    fleet.draw_goal(vehicle);
    EXPECT_NE(vehicle.goal.position, last.position);
    for (const Vehicle& other : fleet.vehicles()) {
      if (&other == &vehicle) continue;
      EXPECT_GE((vehicle.goal.position - other.goal.position).norm(),
                vehicle.type.radius + other.type.radius);
      EXPECT_GE((vehicle.rest.position - other.rest.position).norm(),
                vehicle.type.radius + other.type.radius);
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
