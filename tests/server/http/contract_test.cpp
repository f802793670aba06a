// The real service over a socket.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "server/http/cpp_httplib.h"
#include "server/http_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

using Json = nlohmann::json;

Settings quiet_on_free_port() {
  Settings settings;
  settings.port = 0;
  settings.workers = 2;
  settings.log_level = "off";
  return settings;
}

Json tiny_request() {
  return Json::parse(R"({
    "map": {"rows": ["####......", "..........", ".........."], "resolution": 0.5},
    "robot_defaults": {"radius": 0.2, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [
      {"id": "east", "start": {"x": 0.25, "y": 0.25}, "goal": {"x": 4.75, "y": 0.25, "theta": 1.5}},
      {"id": "west", "start": {"x": 4.75, "y": 0.25}, "goal": {"x": 0.25, "y": 0.25}}
    ]
  })");
}

class Contract : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(server_.bind(), std::nullopt);
    thread_ = std::thread([this] { server_.run(); });
    client_ = std::make_unique<httplib::Client>("127.0.0.1", server_.port());
    client_->set_keep_alive(true);
    client_->set_read_timeout(60);
  }
  void TearDown() override {
    server_.stop();
    thread_.join();
  }

  Json post(const std::string& path, const std::string& body, int status) {
    const auto result = client_->Post(path, body, "application/json");
    EXPECT_TRUE(result);
    if (!result) return {};
    EXPECT_EQ(result->status, status) << result->body;
    const bool problem = status >= 400;
    EXPECT_EQ(result->get_header_value("Content-Type"),
              problem ? "application/problem+json" : "application/json");
    Json json = Json::parse(result->body, nullptr, false);
    EXPECT_EQ(json.value("request_id", result->get_header_value("X-Request-Id")),
              result->get_header_value("X-Request-Id"));
    return json;
  }

  HttpServer server_{quiet_on_free_port(), planning_service()};
  std::thread thread_;
  std::unique_ptr<httplib::Client> client_;
};

TEST_F(Contract, APlanIsSolvedVerifiedAndValid) {
  const Json request = tiny_request();
  const Json answer = post("/v1/plan", request.dump(), 200);
  EXPECT_EQ(answer["status"], "solved") << answer;
  EXPECT_EQ(answer["verified"], true);
  EXPECT_EQ(answer["plans"].size(), 2u);
  EXPECT_GE(answer["timings_ms"]["total"], answer["timings_ms"]["queue"]);
  Json both = request;
  both.update(answer);
  const Json report = post("/v1/validate", both.dump(), 200);
  EXPECT_EQ(report["valid"], true) << report;
}

TEST_F(Contract, EachFaultOfContentIsReportedAndTheNextRequestServed) {
  const std::string deep(3 << 20, '[');
  Json invalid = tiny_request();
  invalid["robots"][0]["radius"] = -1;
  const std::vector<std::pair<std::string, int>> bodies{
      {"", 400},   {"{", 400},  {deep, 400},          {std::string(3 << 20, 'x'), 400},
      {"[]", 422}, {"{}", 422}, {invalid.dump(), 422}};
  for (const char* path : {"/v1/plan", "/v1/validate"}) {
    for (const auto& [body, status] : bodies) {
      const Json problem = post(path, body, status);
      EXPECT_EQ(problem.value("status", 0), status) << body.substr(0, 50);
      EXPECT_EQ(post("/v1/plan", tiny_request().dump(), 200)["status"], "solved");
    }
  }
}

TEST_F(Contract, EveryExampleOfTheServiceIsPlanned) {
  const auto list = client_->Get("/v1/examples");
  ASSERT_TRUE(list);
  const Json examples = Json::parse(list->body)["examples"];
  EXPECT_FALSE(examples.empty());
  for (const auto& example : examples) {
    const auto request = client_->Get("/v1/examples/" + example["name"].get<std::string>());
    ASSERT_TRUE(request);
    ASSERT_EQ(request->status, 200);
    Json body = Json::parse(request->body);
    body["options"]["time_budget_ms"] = 20'000;  // reading counts, too: seconds with ThreadSanitizer
    EXPECT_TRUE(post("/v1/plan", body.dump(), 200).contains("status")) << example;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
