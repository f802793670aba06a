// Streams of events of the real planner, over real sockets.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/server/support/events.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

using Json = nlohmann::json;

constexpr const char* kJsonType = "application/json";

/// Thirty robots of two sizes that all cross a hall; `options` as in a request.
Json crossing_request(const Json& options) {
  Json request = {{"map", {{"rows", std::vector<std::string>(24, std::string(24, '.'))}}},
                  {"robot_defaults", {{"linear_speed", 1.0}, {"angular_speed", 3.0}}},
                  {"options", options},
                  {"robots", Json::array()}};
  for (int k = 0; k < 15; ++k) {
    const double x = 1.5 + 1.5 * k;
    const Json south = {{"x", x}, {"y", 1.5}};
    const Json north = {{"x", 24.0 - x}, {"y", 22.5}};
    const double radius = k % 2 == 0 ? 0.4 : 0.6;
    request["robots"].push_back({{"id", std::string("n") + std::to_string(k)},
                                 {"radius", radius},
                                 {"start", south},
                                 {"goal", north}});
    request["robots"].push_back({{"id", std::string("s") + std::to_string(k)},
                                 {"radius", radius},
                                 {"start", north},
                                 {"goal", south}});
  }
  return request;
}

class LiveStream : public testing::Test {
 protected:
  std::vector<Event> stream(const Json& request) {
    const auto result = client_.Post("/v1/plan", httplib::Headers{{"Accept", "text/event-stream"}},
                                     request.dump(), kJsonType);
    EXPECT_TRUE(result);
    if (!result) return {};
    EXPECT_EQ(result->status, 200) << result->body;
    return events_of(result->body);
  }

  Json post(const std::string& path, const Json& request) {
    const auto result = client_.Post(path, request.dump(), kJsonType);
    EXPECT_TRUE(result && result->status == 200);
    return result ? Json::parse(result->body) : Json();
  }

  TestServer server_{{}, planning_service()};
  httplib::Client client_ = server_.client();
};

TEST_F(LiveStream, SendsProgressAndBetterPlansOfALongPlan) {
  const Json request = crossing_request({{"mode", "anytime"}, {"time_budget_ms", 2500}});
  const auto events = stream(request);
  ASSERT_GT(events.size(), 10U);
  EXPECT_EQ(events.back().name, "plan");

  const auto progress = data_of(events, "progress");
  const double seconds = progress.back()["elapsed_ms"].get<double>() / 1000.0;
  EXPECT_GT(seconds, 1.5);
  EXPECT_GE(static_cast<double>(progress.size()), 4.0 * seconds);
  double elapsed = 0.0;
  double best = std::numeric_limits<double>::infinity();
  for (const Json& one : progress) {
    EXPECT_GE(one["elapsed_ms"].get<double>(), elapsed);
    elapsed = one["elapsed_ms"].get<double>();
    EXPECT_EQ(one["robots"], 30);
    if (one["best"].is_null()) continue;
    EXPECT_EQ(one["planned"], 30);
    EXPECT_LE(one["best"]["flowtime"].get<double>(), best);
    best = one["best"]["flowtime"].get<double>();
  }

  const auto incumbents = data_of(events, "incumbent");
  EXPECT_GE(incumbents.size(), 1U);
  EXPECT_LE(incumbents.size(), 3U) << "at most one a second";
  const Json& plan = events.back().data;
  EXPECT_LE(plan["flowtime"].get<double>(), best);
  for (const Json& incumbent : incumbents) {
    EXPECT_GE(incumbent["flowtime"].get<double>(), plan["flowtime"].get<double>());
    Json both = request;
    both.update(incumbent);
    EXPECT_EQ(post("/v1/validate", both)["valid"], true);
  }
}

TEST_F(LiveStream, EndsWithThePlanOfTheJsonAnswer) {
  for (const Json& options : {Json::object(), Json{{"mode", "anytime"}, {"max_iterations", 60}}}) {
    const Json request = crossing_request(options);
    const auto events = stream(request);
    ASSERT_FALSE(events.empty());
    Json plan = events.back().data;
    Json answer = post("/v1/plan", request);
    EXPECT_EQ(answer["deterministic"], true);
    for (const char* of_its_own : {"request_id", "timings_ms"}) {
      EXPECT_EQ(plan.erase(of_its_own), 1U);
      EXPECT_EQ(answer.erase(of_its_own), 1U);
    }
    EXPECT_EQ(plan, answer);
  }
}

TEST_F(LiveStream, AnswersAnInvalidRequestWithAnOrdinaryError) {
  Json request = crossing_request(Json::object());
  request["robots"][3]["start"]["x"] = -5.0;
  const auto result =
      client_.Post("/v1/plan", httplib::Headers{{"Accept", "text/event-stream"}}, request.dump(), kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 422);
  EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
  EXPECT_EQ(Json::parse(result->body)["errors"][0]["pointer"], "/robots/3/start");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
