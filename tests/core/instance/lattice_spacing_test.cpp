#include <gtest/gtest.h>

#include "core/instance/instance.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::make_problem;
using support::robot_at;

double chosen(double resolution, double radius, const PlanOptions& options = {}) {
  return lattice_spacing(make_problem(OccupancyGrid(100, 100, resolution),
                                      {robot_at(50 * resolution, 50 * resolution).radius(radius)}),
                         options);
}

TEST(LatticeSpacing, IsTheResolutionUnlessCellsAreSmall) {
  EXPECT_EQ(chosen(1.0, 0.3), 1.0);
  EXPECT_EQ(chosen(0.1, 0.39), 0.1);
}

TEST(LatticeSpacing, IsAnOddNumberOfSmallCellsWithinTheRadius) {
  EXPECT_DOUBLE_EQ(chosen(0.05, 0.2), 0.15);
  EXPECT_DOUBLE_EQ(chosen(0.05, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(chosen(0.05, 0.3), 0.25);
  EXPECT_DOUBLE_EQ(chosen(0.05, 0.36), 0.35);
}

TEST(LatticeSpacing, IsThatOfTheSmallestRobot) {
  const Problem problem =
      make_problem(OccupancyGrid(100, 100, 0.1), {robot_at(3, 3).radius(2.0), robot_at(8, 8).radius(0.6)});
  EXPECT_DOUBLE_EQ(lattice_spacing(problem, {}), 0.5);
}

TEST(LatticeSpacing, IsAsAskedFor) {
  PlanOptions options;
  options.lattice_spacing = 0.4;
  EXPECT_EQ(chosen(0.05, 0.3, options), 0.4);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
