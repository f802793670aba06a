#include "core/runtime/budget.h"

#include <gtest/gtest.h>

#include <chrono>

namespace fleetplan::core::budget {
namespace TEST_FILE {

using std::chrono::milliseconds;

Request of_a_second(std::size_t robots, milliseconds reading = milliseconds(4)) {
  return {.budget = milliseconds(1000), .reading = reading, .until_read = reading, .robots = robots};
}

TEST(Budget, KeepsLittleForTheAnswer) {
  EXPECT_EQ(kept_for_answer(of_a_second(10)), milliseconds(25));
  EXPECT_EQ(kept_for_answer(of_a_second(100)), milliseconds(40)) << "0.4 ms for a robot";
  EXPECT_EQ(kept_for_answer(of_a_second(1000)), milliseconds(50)) << "a twentieth";
}

TEST(Budget, KeepsMoreForRequestsThatTakeLongToRead) {
  Request request = of_a_second(10, milliseconds(200));
  EXPECT_EQ(kept_for_answer(request), milliseconds(50));
  request.has_obstacles = true;
  EXPECT_EQ(kept_for_answer(request), milliseconds(100));
  request.is_large_map = true;
  EXPECT_EQ(kept_for_answer(request), milliseconds(200));
  request.reading = milliseconds(900);
  EXPECT_EQ(kept_for_answer(request), milliseconds(500)) << "half of the budget is for planning";
}

TEST(Budget, LeavesThreeQuartersWithDependencies) {
  EXPECT_EQ(for_dependencies(of_a_second(10)), milliseconds(40));
  EXPECT_EQ(for_dependencies(of_a_second(1000)), milliseconds(250));
}

TEST(Budget, HasMorePatienceWithTheLastPlan) {
  const CheckPatience patience = patience_of_service(of_a_second(10));
  EXPECT_LT(patience.if_cancelled, patience.after_planning);
  EXPECT_LT(patience.after_planning, patience.for_nobody);
  EXPECT_EQ(patience_of_service(of_a_second(10, milliseconds(700))).for_nobody, milliseconds(700));
  EXPECT_GT(patience_of_library().after_planning, patience.after_planning);
}

TEST(Budget, GivesTheSafePlanAPartOfTheTime) {
  EXPECT_LT(kShareBeforeSafePlan, kShareWithSafePlan);
  EXPECT_LT(kShareWithSafePlan, kShareAroundKept);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core::budget
