#include "core/plan/part_timer.h"

#include <gtest/gtest.h>

#include <chrono>

namespace fleetplan::core {
namespace TEST_FILE {

using std::chrono::milliseconds;

TEST(PartTimer, AddsUpWhatEachPartHasTaken) {
  const PartTimer::Time begin{};
  PartTimer timer(begin);
  timer.begin(PlanPart::choose, begin + milliseconds(1));
  timer.begin(PlanPart::first_plan, begin + milliseconds(3));
  timer.begin(PlanPart::bounds, begin + milliseconds(7));
  timer.begin(PlanPart::improve, begin + milliseconds(8));
  timer.begin(PlanPart::choose, begin + milliseconds(10));
  timer.begin(PlanPart::first_plan, begin + milliseconds(15));
  EXPECT_EQ(timer.taken(PlanPart::choose), milliseconds(7)) << "twice";
  EXPECT_EQ(timer.taken(PlanPart::first_plan), milliseconds(5)) << "before the first part, too";
  EXPECT_EQ(timer.taken(PlanPart::bounds), milliseconds(1));
  EXPECT_EQ(timer.taken(PlanPart::improve), milliseconds(2));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
