// Plans as streams of events, over real sockets, with a stub in place of the planner.

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "server/http/answer/direct_answers.h"
#include "tests/server/support/events.h"
#include "tests/server/support/soon.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr const char* kJsonType = "application/json";
const httplib::Headers kEvents{{"Accept", "text/event-stream"}};

/// More than the buffers of a socket hold.
const std::string kLargeAnswer = R"({"status":")" + std::string(8 << 20, 'x') + "\"}";

/// The body selects the behaviour: "gate" waits at the gate after begin(), "flood" reports many incumbents,
/// "throw" throws, "fault" is rejected. Any other body is answered at once.
class EventfulService {
 public:
  Service service() {
    Service service = stub_.service();
    service.plan = [this](std::string_view body, const api::RequestContext& context) {
      return answer(body, context);
    };
    service.simulate = service.plan;
    return service;
  }

  Gate gate;
  std::atomic<int> done{0};
  std::atomic<int> stopped{0};
  std::atomic<int> incumbents{0};

 private:
  StubService stub_;

  api::Reply answer(std::string_view body, const api::RequestContext& context) {
    if (body == "fault") return {422, api::kProblemJson, R"({"status":422})"};
    if (context.events != nullptr) context.events->begin({7});
    if (!has_turn(context)) return api::too_busy(context.request_id);
    if (body == "throw") throw std::runtime_error("a secret detail");
    if (body == "flood") flood(*context.events);
    if (body == "gate" && !gate.pass(context.stop)) ++stopped;
    if (context.events != nullptr) context.events->progress({7, {2, 7, core::Objectives{9.0, 3.0}}});
    ++done;
    return {200, api::kJson, R"({"size":)" + std::to_string(body.size()) + "}"};
  }

  void flood(api::PlanEvents& events) {
    for (int k = 0; k < 40; ++k) {
      events.incumbent(kLargeAnswer);
      ++incumbents;
      for (int j = 0; j < 100; ++j) events.progress({7, {j, 0, std::nullopt}});
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
};

class EventStreams : public testing::Test {
 protected:
  static Settings settings() {
    Settings settings;
    settings.workers = 1;
    settings.queue = 1;
    return settings;
  }
  ~EventStreams() override { service.gate.open(); }

  static std::string request(const std::string& body, const std::string& version = "1.1") {
    return "POST /v1/plan HTTP/" + version +
           "\r\nHost: localhost\r\nContent-Type: application/json\r\nAccept: "
           "text/event-stream\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n\r\n" + body;
  }

  EventfulService service;
  TestServer server{settings(), service.service()};
  httplib::Client client = server.client();
};

TEST_F(EventStreams, EndWithThePlan) {
  const auto result = client.Post("/v1/plan", kEvents, "12345", kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  EXPECT_EQ(result->get_header_value("Content-Type"), "text/event-stream");
  EXPECT_EQ(result->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(result->get_header_value("X-Accel-Buffering"), "no");
  EXPECT_FALSE(result->get_header_value("X-Request-Id").empty());
  const auto events = events_of(result->body);
  ASSERT_GE(events.size(), 2U);
  EXPECT_EQ(events.front().name, "progress");
  EXPECT_EQ(events.front().data["robots"], 7);
  EXPECT_EQ(events.back().name, "plan");
  EXPECT_EQ(events.back().data, nlohmann::json::parse(R"({"size":5})"));
}

TEST_F(EventStreams, OfSimulationsEndWithTheirFigures) {
  const auto result = client.Post("/v1/simulate", kEvents, "12345", kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  const auto events = events_of(result->body);
  ASSERT_GE(events.size(), 2U);
  EXPECT_EQ(events.front().name, "progress");
  EXPECT_EQ(events.back().name, "simulation");
  EXPECT_EQ(events.back().data, nlohmann::json::parse(R"({"size":5})"));
}

TEST_F(EventStreams, LeaveTheConnectionOpenForFurtherRequests) {
  for (int i = 0; i < 5; ++i) {
    const auto events = client.Post("/v1/plan", kEvents, "abc", kJsonType);
    ASSERT_TRUE(events);
    EXPECT_EQ(events_of(events->body).back().name, "plan");
    const auto plain = client.Post("/v1/plan", "abcd", kJsonType);
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->get_header_value("Content-Type"), kJsonType);
    EXPECT_EQ(plain->body, R"({"size":4})");
  }
}

TEST_F(EventStreams, EndWithTheConnectionInHttp10) {
  RawConnection old_client(server.server.port());
  old_client.send(request("abc", "1.0"));
  const std::string answer = old_client.receive_all();
  const auto head_end = answer.find("\r\n\r\n");
  ASSERT_NE(head_end, std::string::npos) << answer;
  EXPECT_EQ(answer.find("Transfer-Encoding"), std::string::npos) << answer;
  EXPECT_LT(answer.find("Connection: close"), head_end) << answer;
  EXPECT_EQ(events_of(answer.substr(head_end + 4)).back().name, "plan");
}

TEST_F(EventStreams, AcceptGzipBodiesAndAreNotCompressedThemselves) {
  client.set_compress(true);
  client.set_decompress(false);
  const httplib::Headers headers{{"Accept", "text/event-stream"}, {"Accept-Encoding", "gzip"}};
  const auto result = client.Post("/v1/plan", headers, std::string(100'000, ' '), kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->get_header_value("Content-Encoding"), "");
  EXPECT_EQ(events_of(result->body).back().data["size"], 100'000);
}

TEST_F(EventStreams, AreOrdinaryErrorsForFaultsFoundBeforePlanning) {
  const auto fault = client.Post("/v1/plan", kEvents, "fault", kJsonType);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->status, 422);
  EXPECT_EQ(fault->get_header_value("Content-Type"), "application/problem+json");
  const auto type = client.Post("/v1/plan", kEvents, "abc", "text/plain");
  ASSERT_TRUE(type);
  EXPECT_EQ(type->status, 415);
  EXPECT_EQ(type->get_header_value("Content-Type"), "application/problem+json");
}

TEST_F(EventStreams, EndWithAProblemWithoutTheTextOfAnException) {
  const auto result = client.Post("/v1/plan", kEvents, "throw", kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  const auto events = events_of(result->body);
  EXPECT_EQ(events.back().name, "problem");
  EXPECT_EQ(events.back().data["status"], 500);
  EXPECT_EQ(events.back().data["code"], "internal_error");
  EXPECT_EQ(events.back().data["request_id"], result->get_header_value("X-Request-Id"));
  EXPECT_EQ(result->body.find("secret"), std::string::npos);
}

TEST_F(EventStreams, SendProgressWhileWaitingAndA503WhenTheQueueIsFull) {
  RawConnection running(server.server.port());
  running.send(request("gate"));
  service.gate.await_waiting(1);
  RawConnection waiting(server.server.port());
  waiting.send(request("abc"));
  for (int k = 0; k < 5; ++k) {
    ASSERT_NE(waiting.receive_past(R"("attempt":0,"planned":0,"robots":7)"), "");
  }
  EXPECT_EQ(service.done, 0);
  const auto refused = client.Post("/v1/plan", kEvents, "abc", kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_TRUE(refused->has_header("Retry-After"));
  EXPECT_EQ(refused->get_header_value("Content-Type"), "application/problem+json");
  service.gate.open();
  EXPECT_NE(running.receive_past("event: plan\n"), "");
  EXPECT_NE(waiting.receive_past("event: plan\n"), "");
}

TEST_F(EventStreams, StopTheirPlanWhenTheClientLeaves) {
  {
    RawConnection leaver(server.server.port());
    leaver.send(request("gate"));
    service.gate.await_waiting(1);
    ASSERT_NE(leaver.receive_past("event: progress\n"), "");
  }
  // The only worker is free again, though the gate never opened.
  const auto result = client.Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  EXPECT_EQ(service.stopped, 1);
}

TEST_F(EventStreams, SkipOutdatedEventsForASlowReaderWithoutDelayingOthers) {
  RawConnection slow(server.server.port());
  slow.send(request("flood"));
  ASSERT_TRUE(holds_soon([&] { return service.incumbents > 0; }));
  // Nothing is read yet, but the plan is completed and the worker serves others.
  const auto result = client.Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  EXPECT_EQ(service.incumbents, 40);
  EXPECT_EQ(service.done, 2);
  const std::string stream = slow.receive_past("event: plan\n");
  int incumbents = 0;
  for (auto at = stream.find("event: incumbent\n"); at != std::string::npos;
       at = stream.find("event: incumbent\n", at + 1)) {
    ++incumbents;
  }
  EXPECT_GE(incumbents, 1);
  EXPECT_LT(incumbents, 40);
}

TEST_F(EventStreams, EndWithTheCurrentPlanWhenTheServerStopsJobs) {
  RawConnection waiting(server.server.port());
  waiting.send(request("gate"));
  service.gate.await_waiting(1);
  server.server.begin_drain();
  server.server.cancel_jobs();
  EXPECT_NE(waiting.receive_past("event: plan\n"), "");
  EXPECT_TRUE(waiting.closed_by_server());
  EXPECT_EQ(service.stopped, 1);
}

TEST_F(EventStreams, EndSoonAfterTheServerStopsJobsIfTheClientDoesNotRead) {
  RawConnection stuck(server.server.port());
  stuck.send(request("flood"));  // more than the sockets' buffers hold
  ASSERT_TRUE(holds_soon([&] { return service.done > 0; }));
  server.server.begin_drain();
  EXPECT_FALSE(server.server.idle());
  const auto begin = std::chrono::steady_clock::now();
  server.server.cancel_jobs();
  EXPECT_TRUE(holds_soon([&] { return server.server.idle(); }));
  // Two seconds and some scheduling; without the stop it would be ten.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(7));
}

TEST_F(EventStreams, AreSentForPlansOnly) {
  const auto validated = client.Post("/v1/validate", kEvents, "abc", kJsonType);
  ASSERT_TRUE(validated);
  EXPECT_EQ(validated->get_header_value("Content-Type"), kJsonType);
  EXPECT_EQ(validated->body, R"({"size":3})");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
