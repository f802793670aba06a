// The port for probes and scrapers answers whatever the load of the main port.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr const char* kJsonType = "application/json";

Settings with_admin_port() {
  Settings settings;
  settings.admin_port = 0;
  settings.workers = 1;
  return settings;
}

httplib::Client admin_client(const TestServer& server) {
  httplib::Client client("127.0.0.1", *server.server.admin_port());
  client.set_keep_alive(true);
  return client;
}

int status_of(const httplib::Result& result) { return result ? result->status : 0; }

TEST(AdminPort, IsOffUnlessSet) {
  const TestServer server;
  EXPECT_EQ(server.server.admin_port(), std::nullopt);
}

TEST(AdminPort, AnswersHealthReadinessAndMetricsAndNothingElse) {
  const TestServer server(with_admin_port());
  ASSERT_NE(server.server.admin_port(), server.server.port());
  auto client = admin_client(server);
  EXPECT_EQ(status_of(client.Get("/healthz")), 200);
  EXPECT_EQ(status_of(client.Get("/readyz")), 200);
  EXPECT_EQ(status_of(client.Get("/metrics")), 200);
  for (const char* path : {"/", "/v1/limits", "/v1/examples", "/v1/plan"}) {
    EXPECT_EQ(status_of(client.Get(path)), 404) << path;
  }
  EXPECT_EQ(status_of(client.Post("/v1/plan", "abc", kJsonType)), 404);
  EXPECT_EQ(status_of(client.Post("/healthz", "abc", kJsonType)), 405);
}

TEST(AdminPort, AnswersWhenNoConnectionOfTheMainPortIsLeft) {
  Settings settings = with_admin_port();
  settings.connections = 8;
  settings.idle_timeout = std::chrono::minutes(10);
  const TestServer server(settings);
  std::vector<std::unique_ptr<RawConnection>> idle;
  for (int i = 0; i < 500; ++i) idle.push_back(std::make_unique<RawConnection>(server.server.port()));
  for (int i = 0; i < 3; ++i) {
    auto client = admin_client(server);
    EXPECT_EQ(status_of(client.Get("/healthz")), 200);
    EXPECT_EQ(status_of(client.Get("/readyz")), 200);
    EXPECT_EQ(status_of(client.Get("/metrics")), 200);
  }
}

TEST(AdminPort, RequiresTheTokenForMetrics) {
  Settings settings = with_admin_port();
  settings.token = std::get<AccessToken>(AccessToken::from_text("token"));
  const TestServer server(settings);
  auto client = admin_client(server);
  EXPECT_EQ(status_of(client.Get("/metrics")), 401);
  EXPECT_EQ(status_of(client.Get("/metrics", httplib::Headers{{"Authorization", "Bearer token"}})), 200);
  EXPECT_EQ(status_of(client.Get("/healthz")), 200);
}

TEST(AdminPort, AnswersWhenAllWorkersAreBusyAndTheQueueIsFull) {
  Settings settings = with_admin_port();
  settings.queue = 0;
  TestServer server(settings);
  RawConnection running(server.server.port());
  running.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "4\r\n\r\ngate");
  server.stub.gate.await_waiting(1);
  auto client = admin_client(server);
  EXPECT_EQ(status_of(client.Get("/readyz")), 200);
  server.stub.gate.open();
}

TEST(AdminPort, ReportsThatTheServerDrains) {
  TestServer server(with_admin_port());
  auto client = admin_client(server);
  server.server.begin_drain();
  EXPECT_EQ(status_of(client.Get("/readyz")), 503);
  EXPECT_EQ(status_of(admin_client(server).Get("/healthz")), 200);
}

TEST(AdminPort, ReportsAPortThatIsTaken) {
  const TestServer first(with_admin_port());
  Settings settings = with_admin_port();
  settings.port = 0;
  settings.admin_port = first.server.admin_port();
  settings.log_level = "off";
  StubService stub;
  HttpServer second(settings, stub.service());
  const auto fault = second.bind();
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find(std::to_string(*settings.admin_port)), std::string::npos) << *fault;
  EXPECT_NE(fault->find("in use"), std::string::npos) << *fault;
  EXPECT_NE(fault->find("--admin-port"), std::string::npos) << *fault;
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
