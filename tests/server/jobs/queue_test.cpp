// Requests that wait for a worker, over real sockets.

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace {

using Json = nlohmann::json;

constexpr const char* kJsonType = "application/json";

Settings with_one_worker(std::size_t queue) {
  Settings settings;
  settings.workers = 1;
  settings.queue = queue;
  return settings;
}

/// The planner, except for requests of "gate", which occupy their worker until the test opens the gate.
Service planner_behind(StubService& stub) {
  Service service = planning_service();
  service.plan = [stub = stub.service().plan, plan = service.plan](std::string_view body,
                                                                   const api::RequestContext& context) {
    return body == "gate" ? stub(body, context) : plan(body, context);
  };
  return service;
}

void send_gate(const RawConnection& client) {
  client.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "4\r\n\r\ngate");
}

std::string request_with_budget(int ms) {
  Json request = Json::parse(R"({
    "map": {"rows": ["....", "...."]},
    "robots": [{"id": "a", "radius": 0.3, "linear_speed": 1, "angular_speed": 1,
                "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 3.5, "y": 1.5}}]})");
  request["options"]["time_budget_ms"] = ms;
  return request.dump();
}

TEST(Queue, AnswersARequestWhoseBudgetEndsWhileItWaits) {
  StubService stub;
  const TestServer server(with_one_worker(4), planner_behind(stub));
  const RawConnection running(server.server.port());
  send_gate(running);
  stub.gate.await_waiting(1);
  const auto result = server.client().Post("/v1/plan", request_with_budget(100), kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  const Json answer = Json::parse(result->body);
  EXPECT_EQ(answer["status"], "none");
  EXPECT_EQ(answer["unplanned"][0]["reason"], "budget_exhausted");
  EXPECT_EQ(answer["search"]["expansions"], 0) << "it was not planned";
  EXPECT_GE(answer["timings_ms"]["queue"], 50.0);
  stub.gate.open();
}

TEST(Queue, EstimatesRetryAfterFromTheWorkAhead) {
  StubService stub;
  const TestServer server(with_one_worker(0), planner_behind(stub));
  const RawConnection running(server.server.port());
  send_gate(running);
  stub.gate.await_waiting(1);
  std::this_thread::sleep_for(
      std::chrono::milliseconds(1100));  // the running job has taken more than a second
  const auto refused = server.client().Post("/v1/plan", request_with_budget(1000), kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_GE(std::stoi(refused->get_header_value("Retry-After")), 2);
  stub.gate.open();
}

}  // namespace
}  // namespace fleetplan::server
