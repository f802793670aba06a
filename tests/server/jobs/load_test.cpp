// Many clients, full queues, clients that leave, and the end of the server.

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "api/json/errors.h"
#include "tests/server/support/soon.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr const char* kJsonType = "application/json";

Settings with_workers(int workers, std::size_t queue) {
  Settings settings;
  settings.workers = workers;
  settings.queue = queue;
  return settings;
}

/// A body that gzip cannot make much smaller.
std::string noise(std::string begin, std::size_t size) {
  std::minstd_rand random(1);
  while (begin.size() < size) begin += static_cast<char>(' ' + random() % 64);
  return begin;
}

/// Sends a job that waits at the gate, from a thread of its own: the status, 0 without an answer. `body`
/// begins with "gate".
std::future<int> waiting_job(const TestServer& server, const std::string& body = "gate",
                             bool compressed = false) {
  return std::async(std::launch::async, [&server, body, compressed] {
    auto client = server.client();
    client.set_compress(compressed);
    const auto result = client.Post("/v1/plan", body, kJsonType);
    return result ? result->status : 0;
  });
}

TEST(Load, ManyClientsReceiveTheirOwnAnswers) {
  const TestServer server(with_workers(2, 8));  // more clients than the queue has places, but short jobs
  std::vector<std::thread> threads;
  std::atomic<int> right{0};
  for (int t = 0; t < 50; ++t) {
    threads.emplace_back([&, t] {
      auto client = server.client();
      for (int i = 0; i < 4; ++i) {
        const int size = t * 10 + i;
        const std::string id = "id-" + std::to_string(size);
        const auto result = client.Post("/v1/plan", httplib::Headers{{"X-Request-Id", id}},
                                        std::string(static_cast<std::size_t>(size), ' '), kJsonType);
        if (result && result->status == 200 && result->get_header_value("X-Request-Id") == id &&
            result->body == R"({"size":)" + std::to_string(size) + "}") {
          ++right;
        }
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(right, 200);
}

TEST(Load, ParsesAsManyBodiesAtATimeAsThereAreWorkers) {
  std::atomic<int> parsing{0};
  std::atomic<int> most{0};
  StubService stub;
  Service service = stub.service();
  service.plan = [&](std::string_view, const api::RequestContext& context) {
    for (int now = ++parsing, before = most; now > before && !most.compare_exchange_weak(before, now);) {
    }
    EXPECT_TRUE(holds_soon([&most] { return most >= 2; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // in which a third one would begin
    --parsing;
    if (!has_turn(context)) return api::too_busy(context.request_id);
    return api::Reply{200, api::kJson, "{}"};
  };
  const TestServer server(with_workers(2, 8), service);
  std::vector<std::future<int>> answers;
  for (int k = 0; k < 10; ++k) answers.push_back(waiting_job(server, std::string(1 << 20, ' ')));
  for (auto& answer : answers) EXPECT_EQ(answer.get(), 200);
  EXPECT_EQ(most, 2);
}

TEST(Load, AFullQueueIs503WithRetryAfterWhileHealthAnswers) {
  TestServer server(with_workers(1, 0));
  auto running = waiting_job(server);
  server.stub.gate.await_waiting(1);
  auto client = server.client();
  const auto refused = client.Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_NE(refused->body.find("overloaded"), std::string::npos);
  EXPECT_GE(std::stoi(refused->get_header_value("Retry-After")), 1);
  const auto health = client.Get("/healthz");
  ASSERT_TRUE(health);
  EXPECT_EQ(health->status, 200);
  server.stub.gate.open();
  EXPECT_EQ(running.get(), 200);
}

TEST(Load, IdleConnectionsDoNotBlockOthers) {
  Settings settings = with_workers(2, 8);
  settings.idle_timeout = std::chrono::minutes(10);
  const TestServer server(settings);
  std::vector<std::unique_ptr<RawConnection>> idle;
  for (int i = 0; i < 64; ++i) {
    idle.push_back(std::make_unique<RawConnection>(server.server.port()));
    idle.back()->send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_NE(idle.back()->receive().find("200 OK"), std::string::npos);
  }
  const auto result = server.client().Get("/healthz");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
}

TEST(Load, ConnectionsBeyondTheLimitWaitForOneToEnd) {
  Settings settings = with_workers(1, 8);
  settings.connections = 2;
  settings.idle_timeout = std::chrono::milliseconds(50);
  const TestServer server(settings);
  std::vector<std::unique_ptr<RawConnection>> clients;
  for (int i = 0; i < 6; ++i) {
    clients.push_back(std::make_unique<RawConnection>(server.server.port()));
    clients.back()->send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  for (auto& client : clients) EXPECT_NE(client->receive().find("200 OK"), std::string::npos);
}

TEST(Load, TheLargestBodyIsAcceptedWithoutAQueue) {
  Settings settings = with_workers(1, 0);
  settings.limits.max_body = 2 * BodyMemory::kSmall;
  const TestServer server(settings);
  const std::string body = noise("", settings.limits.max_body);
  auto client = server.client();
  for (const bool compressed : {false, true}) {
    client.set_compress(compressed);
    const auto result = client.Post("/v1/plan", body, kJsonType);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->body, R"({"size":131072})");
  }
}

/// A body of some kilobytes may have a map of many pixels. While such bodies are read, small bodies of others
/// are read, too.
TEST(Load, SmallBodiesAreReadBesideAnyNumberOfImages) {
  StubService stub;
  Service service = stub.service();
  Gate reading;  // bodies that begin with "image" are read until it opens
  const auto parsed = service.plan;
  service.plan = [&](std::string_view body, const api::RequestContext& context) {
    if (body.starts_with("image")) reading.pass(context.stop);
    return parsed(body, context);
  };
  const TestServer server(with_workers(1, 8), service);
  std::vector<std::future<int>> images;
  for (const bool compressed : {false, false, true, true}) {
    images.push_back(waiting_job(server, R"(image "png")", compressed));
  }
  reading.await_waiting(1);
  auto client = server.client();
  for (int k = 0; k < 20; ++k) {
    const auto result = client.Post("/v1/plan", "abc", kJsonType);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 200);
  }
  reading.open();
  for (auto& image : images) EXPECT_EQ(image.get(), 200);
}

TEST(Load, ManyLargeBodiesAreRejectedWhileSmallOnesAreAccepted) {
  Settings settings = with_workers(3, 0);
  settings.limits.max_body = 1 << 20;  // so that all bodies together have 4 MiB
  TestServer server(settings);
  const std::string held_body = noise("gate", settings.limits.max_body);
  auto first = waiting_job(server, held_body, true);  // holds it compressed and decoded: 1.75 MiB or more
  server.stub.gate.await_waiting(1);
  auto second = waiting_job(server, held_body, true);
  server.stub.gate.await_waiting(2);

  auto client = server.client();
  const std::string large(5 << 17, ' ');
  for (const bool compressed : {false, true}) {
    client.set_compress(compressed);
    const auto refused = client.Post("/v1/plan", large, kJsonType);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 503);
    EXPECT_NE(refused->body.find("Too many large requests"), std::string::npos);
    EXPECT_TRUE(refused->has_header("Retry-After"));
    const auto small = client.Post("/v1/plan", "abc", kJsonType);
    ASSERT_TRUE(small);
    EXPECT_EQ(small->status, 200);
  }

  server.stub.gate.open();
  EXPECT_EQ(first.get(), 200);
  EXPECT_EQ(second.get(), 200);
  EXPECT_TRUE(holds_soon([&] {  // once their connections have released the bodies
    const auto after = client.Post("/v1/plan", large, kJsonType);
    return after && after->status == 200;
  }));
}

TEST(Load, ClientsThatReadNothingKeepNoMemoryFromOthers) {
  constexpr std::size_t kAnswer = 8 << 20;
  Settings settings = with_workers(2, 32);
  settings.max_unsent = 2 * kAnswer;
  StubService stub;
  Service service = stub.service();
  service.plan = [&](std::string_view, const api::RequestContext& context) {
    if (!has_turn(context)) return api::too_busy(context.request_id);
    return api::Reply{200, api::kJson, std::string(kAnswer, '1')};
  };
  const TestServer server(settings, service);
  std::vector<std::unique_ptr<RawConnection>> silent;
  for (int k = 0; k < 12; ++k) {
    silent.push_back(std::make_unique<RawConnection>(server.server.port()));
    silent.back()->send(
        "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
        "1\r\n\r\n1");
  }
  const auto metric = [&](const std::string& name) {
    const auto metrics = server.client().Get("/metrics");
    const auto at = metrics ? metrics->body.find("\n" + name + ' ') : std::string::npos;
    return at == std::string::npos ? -1.0 : std::stod(metrics->body.substr(at + name.size() + 2));
  };
  ASSERT_TRUE(holds_soon([&] { return metric("fleetplan_unsent_dropped_total") >= 10.0; }));
  EXPECT_LE(metric("fleetplan_unsent_bytes"), 2.0 * kAnswer);
  for (int k = 0; k < 3; ++k) {
    const auto answered = server.client().Post("/v1/plan", "1", kJsonType);
    ASSERT_TRUE(answered);
    EXPECT_EQ(answered->body.size(), kAnswer);
  }
}

TEST(Leaving, StopsThePlan) {
  TestServer server(with_workers(1, 1));
  {
    RawConnection client(server.server.port());
    client.send(
        "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
        "4\r\n\r\ngate");
    server.stub.gate.await_waiting(1);
  }
  // The only worker is free again, though the gate never opened.
  const auto result = server.client().Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  EXPECT_EQ(server.stub.stopped, 1);
}

TEST(Leaving, ByClosingOneHalfOfTheConnectionStopsThePlan) {
  TestServer server(with_workers(1, 1));
  RawConnection client(server.server.port());
  client.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "4\r\n\r\ngate");
  server.stub.gate.await_waiting(1);
  client.end_of_sending();
  EXPECT_TRUE(holds_soon([&] { return server.stub.stopped == 1; }));
}

TEST(Draining, RejectsNewJobsButAnswersRunningOnes) {
  TestServer server(with_workers(1, 4));
  auto running = waiting_job(server);
  server.stub.gate.await_waiting(1);
  server.server.begin_drain();
  EXPECT_FALSE(server.server.idle());

  auto client = server.client();
  const auto refused = client.Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_NE(refused->body.find("draining"), std::string::npos);
  EXPECT_TRUE(refused->has_header("Retry-After"));
  EXPECT_EQ(refused->get_header_value("Connection"), "close");
  const auto ready = client.Get("/readyz");
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->status, 503);
  EXPECT_TRUE(ready->has_header("Retry-After"));
  const auto health = client.Get("/healthz");
  ASSERT_TRUE(health);
  EXPECT_EQ(health->status, 200);

  server.stub.gate.open();
  EXPECT_EQ(running.get(), 200);
}

TEST(Draining, StopsJobsThatTakeTooLong) {
  TestServer server(with_workers(1, 4));
  auto running = waiting_job(server);
  server.stub.gate.await_waiting(1);
  server.server.begin_drain();
  server.server.cancel_jobs();
  EXPECT_EQ(running.get(), 200);
  EXPECT_EQ(server.stub.stopped, 1);
}

TEST(Draining, AnswersCancelledJobsWithRetryAfter) {
  StubService stub;
  Service service = stub.service();
  service.validate = [](std::string_view, const api::RequestContext& context) {
    return api::problem_reply(api::ErrorCode::draining, "Try another replica.", context.request_id);
  };
  const TestServer server(with_workers(1, 4), service);
  const auto refused = server.client().Post("/v1/validate", "abc", kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_TRUE(refused->has_header("Retry-After"));
}

TEST(Draining, IsAnnouncedBeforeAnythingIsRejected) {
  TestServer server(with_workers(1, 4));
  auto client = server.client();
  server.server.announce_end();
  const auto ready = client.Get("/readyz");
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->status, 503);
  const auto served = client.Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(served);
  EXPECT_EQ(served->status, 200);
}

TEST(Draining, DoesNotWaitForBodiesOnceJobsAreCancelled) {
  TestServer server(with_workers(1, 4));
  RawConnection slow(server.server.port());
  slow.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "10\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(slow.receive(), "HTTP/1.1 100 Continue\r\n\r\n");
  slow.send("abc");
  server.server.begin_drain();
  server.server.cancel_jobs();
  const std::string answer = slow.receive();
  EXPECT_EQ(answer.find("HTTP/1.1 503 "), 0u) << answer;
  EXPECT_NE(answer.find("draining"), std::string::npos) << answer;
  EXPECT_NE(answer.find("\r\nRetry-After: "), std::string::npos) << answer;
  EXPECT_TRUE(slow.closed_by_server());
  EXPECT_TRUE(holds_soon([&] { return server.server.idle(); }));
}

TEST(Stopping, EndsIdleConnectionsAtOnce) {
  Settings settings;
  settings.idle_timeout = std::chrono::minutes(10);
  TestServer server(settings);
  RawConnection idle(server.server.port());
  idle.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(idle.receive().find("200 OK"), std::string::npos);
  server.stop();
  EXPECT_TRUE(idle.closed_by_server());
}

TEST(Binding, TwiceToOnePortFailsWithAMessage) {
  const TestServer first;
  Settings settings;
  settings.port = first.server.port();
  settings.log_level = "off";
  StubService stub;
  HttpServer second(settings, stub.service());
  const auto fault = second.bind();
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("127.0.0.1:" + std::to_string(settings.port)), std::string::npos) << *fault;
  EXPECT_NE(fault->find("in use"), std::string::npos) << *fault;
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
