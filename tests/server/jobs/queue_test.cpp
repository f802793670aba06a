// Requests that wait for a worker, over real sockets.

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/support/soon.h"
#include "tests/server/support/test_server.h"
#include "tests/support/sanitized.h"

namespace fleetplan::server {
namespace TEST_FILE {

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

/// One robot. Whether the job counts as short depends on the size of the map.
Json request_with_budget(int ms, int rows = 400) {
  Json request = Json::parse(R"({
    "robots": [{"id": "a", "radius": 0.3, "linear_speed": 1, "angular_speed": 1,
                "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 3.5, "y": 1.5}}]})");
  request["map"]["rows"] = std::vector<std::string>(static_cast<std::size_t>(rows), std::string(400, '.'));
  request["options"]["time_budget_ms"] = ms;
  return request;
}

/// Robots that meet head-on in a hall, so that their plan can be improved for ever.
Json endless_request() {
  Json request = request_with_budget(60'000);
  request["options"]["mode"] = "anytime";
  request["robots"] = Json::array();
  for (int k = 0; k < 20; ++k) {
    const Json west = {{"x", 1.5}, {"y", 50.5 + k}};
    const Json east = {{"x", 30.5}, {"y", 50.5 + k}};
    const std::string number = std::to_string(k);
    request["robots"].push_back({{"id", "eastward-" + number}, {"start", west}, {"goal", east}});
    request["robots"].push_back({{"id", "westward-" + number}, {"start", east}, {"goal", west}});
  }
  request["robot_defaults"] = {{"radius", 0.4}, {"linear_speed", 1.0}, {"angular_speed", 2.0}};
  return request;
}

void post(const RawConnection& client, const Json& request) {
  const std::string body = request.dump();
  client.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
      std::to_string(body.size()) + "\r\n\r\n" + body);
}

TEST(Queue, RefusesARequestWhoseTurnDoesNotComeInItsTime) {
  StubService stub;
  const TestServer server(with_one_worker(4), planner_behind(stub));
  const RawConnection running(server.server.port());
  send_gate(running);
  stub.gate.await_waiting(1);
  const auto result = server.client().Post("/v1/plan", request_with_budget(1000).dump(), kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 503);
  EXPECT_EQ(Json::parse(result->body)["code"], "overloaded");
  EXPECT_GE(std::stoi(result->get_header_value("Retry-After")), 1);
  stub.gate.open();
}

TEST(Queue, ServesShortJobsBesideLongOnes) {
  StubService stub;
  const TestServer server(with_one_worker(4), planner_behind(stub));
  const RawConnection running(server.server.port());
  send_gate(running);
  stub.gate.await_waiting(1);
  Json request = request_with_budget(60'000, 10);
  const auto planned = server.client().Post("/v1/plan", request.dump(), kJsonType);
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->status, 200);
  request["plans"] = Json::parse(planned->body)["plans"];
  const auto checked = server.client().Post("/v1/validate", request.dump(), kJsonType);
  ASSERT_TRUE(checked);
  EXPECT_EQ(checked->status, 200) << checked->body;
  stub.gate.open();
}

TEST(Queue, MakesFirstPlansWhileOthersImproveTheirs) {
  const TestServer server(with_one_worker(4), planning_service());
  std::vector<std::unique_ptr<RawConnection>> improving;
  for (int k = 0; k < 2; ++k) {
    improving.push_back(std::make_unique<RawConnection>(server.server.port()));
    post(*improving.back(), endless_request());
  }
  const auto has_metric = [&](const char* line) {
    const auto metrics = server.client().Get("/metrics");
    return metrics && metrics->body.find(line) != std::string::npos;
  };
  ASSERT_TRUE(holds_soon([&] { return has_metric("fleetplan_improvements_paused 1\n"); }));
  for (int k = 0; k < 3; ++k) {
    const auto planned = server.client().Post("/v1/plan", request_with_budget(50'000).dump(), kJsonType);
    ASSERT_TRUE(planned);
    EXPECT_EQ(planned->status, 200);
    EXPECT_EQ(Json::parse(planned->body)["status"], "solved");
  }
  // The worker has at most one paused improvement. So one of two has ended with what it had.
  EXPECT_TRUE(holds_soon([&] { return has_metric("fleetplan_improvements_ended_total 1\n"); }));
}

TEST(Queue, InterruptsSimulationsForOthersWithoutCuttingThem) {
  StubService stub;
  const TestServer server(with_one_worker(4), planner_behind(stub));
  Json request = endless_request();
  request["options"] = {{"time_budget_ms", 60'000}};
  const auto planned = server.client().Post("/v1/plan", request.dump(), kJsonType);
  ASSERT_TRUE(planned);
  ASSERT_EQ(planned->status, 200) << planned->body;
  request["plans"] = Json::parse(planned->body)["plans"];
  request["policy"] = "open_loop";
  const int runs = support::kSanitized ? 1'000 : 10'000;  // seconds
  request["runs"] = runs;
  auto simulation = std::async(std::launch::async, [&] {
    auto client = server.client();
    client.set_read_timeout(std::chrono::minutes(2));
    return client.Post("/v1/simulate", request.dump(), kJsonType);
  });
  ASSERT_TRUE(holds_soon([&] {
    const auto metrics = server.client().Get("/metrics");
    return metrics && metrics->body.find("fleetplan_workers_busy 1\n") != std::string::npos;
  }));
  const RawConnection other(server.server.port());
  send_gate(other);
  stub.gate.await_waiting(1);  // it has the only turn, in the middle of the simulation
  EXPECT_EQ(simulation.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  stub.gate.open();
  const auto simulated = simulation.get();
  ASSERT_TRUE(simulated);
  ASSERT_EQ(simulated->status, 200) << simulated->body;
  EXPECT_EQ(Json::parse(simulated->body)["runs"], runs);
}

TEST(Queue, EstimatesRetryAfterFromTheWorkAhead) {
  StubService stub;
  const TestServer server(with_one_worker(0), planner_behind(stub));
  const RawConnection running(server.server.port());
  send_gate(running);
  stub.gate.await_waiting(1);
  std::this_thread::sleep_for(
      std::chrono::milliseconds(1100));  // the running job has taken more than a second
  const auto refused = server.client().Post("/v1/plan", request_with_budget(1000).dump(), kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_GE(std::stoi(refused->get_header_value("Retry-After")), 2);
  stub.gate.open();
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
