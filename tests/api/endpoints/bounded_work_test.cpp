#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "core/plan/planner.h"
#include "core/runtime/memory_account.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

RequestContext context_with(std::size_t mebibytes) {
  RequestContext context;
  context.request_id = "test-7";
  context.limits.max_plan_memory = mebibytes << 20;
  return context;
}

std::vector<char> block(std::size_t mebibytes) { return std::vector<char>(mebibytes << 20); }

TEST(BoundedWork, RejectsWorkThatNeedsMoreThanItsLimit) {
  const Reply reply = bounded_work(context_with(8), [](core::Work& /*work*/) {
    block(9);
    return Reply{};
  });
  EXPECT_EQ(reply.status, 422);
  EXPECT_EQ(json_of(reply)["code"], "memory_exceeded");
  EXPECT_EQ(json_of(reply)["request_id"], "test-7");
  EXPECT_THAT(json_of(reply)["detail"].get<std::string>(), HasSubstr("8 MiB"));
}

#if !defined(FLEETPLAN_ADDRESS_SANITIZER) && !defined(FLEETPLAN_THREAD_SANITIZER)  // they end the process
/// More than any process has.
constexpr std::size_t kMebibytesOfNone = std::size_t{1} << 30;

TEST(BoundedWork, IsPutOffWhenTheProcessHasNoMemoryForWhatIsGranted) {
  for (const bool any_refused : {false, true}) {
    const Reply reply = bounded_work(context_with(2 * kMebibytesOfNone), [&](core::Work& /*work*/) {
      if (any_refused) {
        EXPECT_THROW(block(4 * kMebibytesOfNone), std::bad_alloc);
      }
      block(kMebibytesOfNone);
      return Reply{};
    });
    EXPECT_EQ(reply.status, 503);
    EXPECT_EQ(json_of(reply)["code"], "overloaded");
  }
}

TEST(BoundedWork, IsRefusedWhenItNeedsMoreThanItsLimitAndTheProcessHasLessAnyway) {
  const Reply reply = bounded_work(context_with(8), [](core::Work& /*work*/) {
    block(kMebibytesOfNone);
    return Reply{};
  });
  EXPECT_EQ(json_of(reply)["code"], "memory_exceeded");
}

TEST(BoundedWork, PutsAPlanOffWhenTheProcessHasNoMemory) {
  const Planner planner = [](const auto&, const auto&, const auto&, auto*) -> core::Plan {
    block(kMebibytesOfNone);
    return {};
  };
  const Reply reply = plan_with(planner, swap_request().dump(), context_with(2 * kMebibytesOfNone));
  EXPECT_EQ(json_of(reply)["code"], "overloaded");
}
#endif

TEST(BoundedWork, LeavesMuchMemoryToBeFreedAfterTheAnswer) {
  const Reply large = bounded_work(context_with(64), [](core::Work& /*work*/) {
    core::keep_for_later(std::make_shared<std::vector<char>>(block(16)));
    return Reply{};
  });
  EXPECT_TRUE(large.leftovers);
  const Reply small = bounded_work(context_with(64), [](core::Work& /*work*/) {
    core::keep_for_later(std::make_shared<std::vector<char>>(block(1)));
    return Reply{};
  });
  EXPECT_FALSE(small.leftovers);
}

TEST(BoundedWork, IsForTheBodiesOfBothEndpoints) {
  Json request = swap_request();
  request["map"]["rows"] = Json::array();
  for (int row = 0; row < 2000; ++row) request["map"]["rows"].push_back(std::string(1000, '.'));
  request["plans"] = Json::array();
  EXPECT_EQ(json_of(validate_endpoint(request.dump(), context_with(1)))["code"], "memory_exceeded");
  request.erase("plans");
  EXPECT_EQ(json_of(plan_endpoint(request.dump(), context_with(1)))["code"], "memory_exceeded");
}

TEST(BoundedWork, AnswersWithoutAPlanWhenThePlannerNeedsMore) {
  const Planner greedy = [](const auto&, const auto&, const auto&, auto*) -> core::Plan {
    block(64);
    return {};
  };
  const Reply reply = plan_with(greedy, swap_request().dump(), context_with(32));
  ASSERT_EQ(reply.status, 200);
  const Json answer = json_of(reply);
  EXPECT_EQ(answer["status"], "none");
  EXPECT_EQ(answer["deterministic"], false);
  EXPECT_EQ(answer["unplanned"][0]["reason"], "budget_exhausted");
  EXPECT_EQ(answer["unplanned"][0]["detail"], core::kMemorySpent);
}

/// The planner has used its memory, but still holds a plan to be checked.
TEST(BoundedWork, ChecksThePlanOfAJobThatIsShortOfMemory) {
  const Planner hoarder = [](const core::Problem& problem, const auto& options, const auto& stop, auto*) {
    core::Plan plan = core::plan(problem, options, stop);
    core::MemoryScope::current()->keep(std::make_shared<std::vector<char>>(block(25)));
    EXPECT_TRUE(core::is_short_of_memory());
    return plan;
  };
  const Json answer = json_of(plan_with(hoarder, swap_request().dump(), context_with(32)));
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(answer["verified"], true);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
