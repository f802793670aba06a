#include <fleetplan/fleetplan.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <stop_token>

#include "tests/library/fleet.h"

namespace fleetplan {
namespace TEST_FILE {

MarginsQuestion usual_question() {
  MarginsQuestion question;
  question.disturbance.speed = {0.8, 1.0};
  question.disturbance.stops_per_hour = 60.0;
  question.disturbance.mean_stop = 5.0;
  return question;
}

TEST(PublicMargins, FindThePlanThatHolds) {
  const Problem problem = corridor_swap();
  Options options;
  options.time_budget = std::chrono::minutes(2);
  const FoundMargins found = find_margins(problem, usual_question(), options);
  ASSERT_EQ(found.tried.size(), 6U);
  ASSERT_TRUE(found.best);
  EXPECT_TRUE(found.deterministic);
  EXPECT_EQ(found.tried[*found.best].status, TriedMargins::Status::met);
  ASSERT_TRUE(found.plan);
  EXPECT_TRUE(found.plan->verified);
  EXPECT_EQ(found.plan->objectives.flowtime, found.tried[*found.best].planned->flowtime);
  EXPECT_FALSE(found.dependencies.empty());
  EXPECT_TRUE(verify(problem, *found.plan).valid());
  EXPECT_TRUE(found.tried[0].tight);
}

TEST(PublicMargins, AreNoneWithoutTime) {
  std::stop_source stop;
  stop.request_stop();
  const FoundMargins found = find_margins(corridor_swap(), usual_question(), {}, {.stop = stop.get_token()});
  EXPECT_TRUE(found.tried.empty());
  EXPECT_FALSE(found.best);
  EXPECT_FALSE(found.deterministic);
}

TEST(PublicMargins, RejectQuestionsOutOfTheirRanges) {
  MarginsQuestion question = usual_question();
  question.collisions = 0.0;
  EXPECT_THROW(find_margins(corridor_swap(), question), std::invalid_argument);
  question = usual_question();
  question.body_radii = {0.1};
  EXPECT_THROW(find_margins(corridor_swap(), question), std::invalid_argument);
  Problem problem = corridor_swap();
  problem.robots[0].radius = -1.0;
  EXPECT_THROW(find_margins(problem, usual_question()), InvalidProblem);
}

}  // namespace TEST_FILE
}  // namespace fleetplan
