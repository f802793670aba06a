// Workers without a request help with requests of others.

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

using Json = nlohmann::json;

Settings with_workers(int workers) {
  Settings settings;
  settings.workers = workers;
  return settings;
}

Json planned(int workers, const Json& request) {
  const TestServer server(with_workers(workers), planning_service());
  const auto result = server.client().Post("/v1/plan", request.dump(), "application/json");
  if (!result || result->status != 200) throw std::runtime_error(result ? result->body : "no answer");
  return Json::parse(result->body);
}

/// A dozen robots that cross a room with a pillar, half of them in each direction.
Json crossing_request() {
  Json request = Json::parse(R"({
    "map": {"rows": ["..........", "..........", "..........", "....##....", "....##....", "..........",
                     "..........", ".........."], "resolution": 1.0},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "options": {"mode": "anytime", "max_iterations": 120, "seed": 5, "time_budget_ms": 60000},
    "robots": []
  })");
  for (int k = 0; k < 6; ++k) {
    const double y = k + 1.5;
    const Json west = {{"x", 0.5}, {"y", y}};
    const Json east = {{"x", 9.5}, {"y", 8.0 - y}};
    const Json north = {{"x", k + 2.5}, {"y", 0.5}};
    const Json south = {{"x", 7.5 - k}, {"y", 7.5}};
    request["robots"].push_back({{"id", "eastward-" + std::to_string(k)}, {"start", west}, {"goal", east}});
    request["robots"].push_back(
        {{"id", "southward-" + std::to_string(k)}, {"start", north}, {"goal", south}});
  }
  return request;
}

TEST(IdleWorkers, HelpWithTheRequestOfAnother) {
  Service service = planning_service();
  service.plan = [](std::string_view, const api::RequestContext& context) {
    std::latch both(2);
    context.executor->run(2, [&](std::size_t) { both.arrive_and_wait(); });  // never ends on one thread
    return api::Reply{200, api::kJson, "{}"};
  };
  const TestServer server(with_workers(2), service);
  const auto result = server.client().Post("/v1/plan", "{}", "application/json");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
}

TEST(IdleWorkers, PassTheirExceptionsToTheRequest) {
  Service service = planning_service();
  service.plan = [](std::string_view, const api::RequestContext& context) {
    std::latch both(2);
    context.executor->run(2, [&](std::size_t) {
      both.arrive_and_wait();
      throw std::runtime_error("a bug");
    });
    return api::Reply{200, api::kJson, "{}"};
  };
  const TestServer server(with_workers(2), service);
  const auto result = server.client().Post("/v1/plan", "{}", "application/json");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 500);
}

TEST(IdleWorkers, DoNotChangeThePlan) {
  const Json request = crossing_request();
  const Json alone = planned(1, request);
  EXPECT_EQ(alone["deterministic"], true);
  EXPECT_EQ(alone["status"], "solved");
  EXPECT_GT(alone["search"]["improvements"], 0) << alone["search"];
  const Json helped = planned(4, request);
  EXPECT_EQ(helped["deterministic"], true);
  EXPECT_EQ(helped["plans"].dump(), alone["plans"].dump());
  EXPECT_EQ(helped["search"], alone["search"]);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
