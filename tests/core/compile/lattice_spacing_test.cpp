#include <gtest/gtest.h>

#include "core/compile/instance.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::make_problem;
using support::robot_at;

double chosen(double resolution, double radius, const PlanOptions& options = {}) {
  return lattice_spacings(make_problem(OccupancyGrid(100, 100, resolution),
                                       {robot_at(50 * resolution, 50 * resolution).radius(radius)}),
                          options)[0];
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

TEST(LatticeSpacing, DoesNotDependOnOtherRobots) {
  const Problem problem =
      make_problem(OccupancyGrid(100, 100, 0.1), {robot_at(3, 3).radius(2.0), robot_at(8, 8).radius(0.6),
                                                  robot_at(8, 4).radius(0.62), robot_at(1, 8).radius(0.2)});
  const std::vector<double> spacings = lattice_spacings(problem, {});
  ASSERT_EQ(spacings.size(), 4U);
  EXPECT_DOUBLE_EQ(spacings[0], 1.9);
  EXPECT_DOUBLE_EQ(spacings[1], 0.5);
  EXPECT_EQ(spacings[2], spacings[1]);
  EXPECT_EQ(spacings[3], 0.1);
  const Instance instance(problem, {}, StopCondition::never());
  EXPECT_EQ(&instance.lattice(1), &instance.lattice(2));
  EXPECT_EQ(instance.lattice(3).spacing(), 0.1);
}

TEST(LatticeSpacing, IsThatOfTheSmallestRadiusOfARobotWithLoads) {
  Robot carrier = robot_at(3, 3).radius(0.9).to(8, 8);
  carrier.goal->radius_after = 0.6;
  const Problem problem = make_problem(OccupancyGrid(100, 100, 0.1), {carrier, robot_at(8, 3).radius(0.9)});
  EXPECT_DOUBLE_EQ(lattice_spacings(problem, {})[0], 0.5);
  EXPECT_DOUBLE_EQ(lattice_spacings(problem, {})[1], 0.9);
}

TEST(LatticeSpacing, IsAsAskedFor) {
  PlanOptions options;
  options.lattice_spacing = 0.4;
  EXPECT_EQ(chosen(0.05, 0.3, options), 0.4);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
