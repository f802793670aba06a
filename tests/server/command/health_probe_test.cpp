#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/command/commands.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

using testing::HasSubstr;
using testing::Optional;

Settings at_port(int port) {
  Settings settings;
  settings.port = port;
  return settings;
}

TEST(HealthProbe, ReportsNoFaultWhenTheServiceAnswers) {
  const TestServer server;
  EXPECT_EQ(health_fault(at_port(server.server.port())), std::nullopt);
}

TEST(HealthProbe, UsesTheLoopbackForAServiceOnAllAddresses) {
  const TestServer server;
  Settings settings = at_port(server.server.port());
  settings.host = "0.0.0.0";
  EXPECT_EQ(health_fault(settings), std::nullopt);
}

TEST(HealthProbe, UsesTheAdminPortIfSet) {
  Settings with_admin_port;
  with_admin_port.admin_port = 0;
  const TestServer server(with_admin_port);
  Settings settings = at_port(0);
  settings.admin_port = server.server.admin_port();
  EXPECT_EQ(health_fault(settings), std::nullopt);
}

TEST(HealthProbe, NeedsNoToken) {
  Settings settings;
  settings.token = std::get<AccessToken>(AccessToken::from_text("open-sesame"));
  const TestServer server(settings);
  EXPECT_EQ(health_fault(at_port(server.server.port())), std::nullopt);
}

TEST(HealthProbe, TreatsADrainingServiceAsAlive) {
  TestServer server;
  server.server.begin_drain();
  EXPECT_EQ(health_fault(at_port(server.server.port())), std::nullopt);
}

TEST(HealthProbe, NamesTheAddressThatDoesNotAnswer) {
  TestServer server;
  const int port = server.server.port();
  server.stop();
  EXPECT_THAT(health_fault(at_port(port)),
              Optional(HasSubstr("no answer from 127.0.0.1 port " + std::to_string(port) + ": ")));
}

TEST(HealthProbe, RejectsAnotherService) {
  httplib::Server other;  // without any route
  const int port = other.bind_to_any_port("127.0.0.1");
  std::thread serving([&] { other.listen_after_bind(); });
  const auto fault = health_fault(at_port(port));
  other.stop();
  serving.join();
  EXPECT_EQ(fault, "127.0.0.1 port " + std::to_string(port) + " answered /healthz with 404");
}

TEST(HealthProbe, RejectsPortZero) { EXPECT_THAT(health_fault(at_port(0)), Optional(HasSubstr("name one"))); }

}  // namespace TEST_FILE
}  // namespace fleetplan::server
