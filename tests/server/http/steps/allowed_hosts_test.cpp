#include "server/http/steps/allowed_hosts.h"

#include <gtest/gtest.h>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

bool admits(const AllowedHosts& hosts, const std::optional<std::string>& host) {
  RequestHead head;
  head.host = host;
  return hosts.admits(head);
}

TEST(AllowedHosts, OfAServiceOnLoopbackAreLocalNamesAndThoseOfTheSetting) {
  for (const char* listening : {"127.0.0.1", "localhost", "::1"}) {
    const AllowedHosts hosts(listening, {"Fleet.example"});
    for (const char* host : {"localhost", "LOCALHOST:1", "127.0.0.1:8080", "127.1.2.3", "[::1]:80",
                             "fleet.example", "FLEET.EXAMPLE:8080"}) {
      EXPECT_TRUE(admits(hosts, host)) << host;
    }
    for (const char* host : {"", "evil.example", "evil.example:8080", "a.fleet.example",
                             "localhost.evil.example", "10.0.0.1", "127.0.0.1.evil.example"}) {
      EXPECT_FALSE(admits(hosts, host)) << host;
    }
    EXPECT_TRUE(admits(hosts, std::nullopt)) << "HTTP/1.0";
  }
}

TEST(AllowedHosts, AreAllElsewhereOrWithAStar) {
  EXPECT_TRUE(admits(AllowedHosts("0.0.0.0", {}), "any.example"));
  EXPECT_TRUE(admits(AllowedHosts("::", {"fleet.example"}), "any.example"));
  EXPECT_TRUE(admits(AllowedHosts("127.0.0.1", {"*"}), "any.example"));
}

TEST(AllowedHosts, AreNamesWithoutPort) {
  for (const char* good : {"*", "fleet.example", "10.0.0.1", "[::2]"}) {
    EXPECT_EQ(host_name_fault(good), std::nullopt) << good;
  }
  for (const char* bad : {"", "fleet.example:80", "fleet.example:", "http://fleet.example", "a b", "a/"}) {
    EXPECT_NE(host_name_fault(bad), std::nullopt) << bad;
  }
}

TEST(WrongHost, Is421OnEveryPath) {
  const TestServer server;
  for (const char* line : {"GET /", "GET /healthz", "GET /nowhere", "HEAD /metrics", "OPTIONS /v1/plan"}) {
    RawConnection raw(server.server.port());
    raw.send(std::string(line) + " HTTP/1.1\r\nHost: rebound.example\r\n\r\n");
    EXPECT_EQ(raw.receive_past("\r\n"), "HTTP/1.1 421 Misdirected Request\r\n") << line;
  }
  RawConnection absolute(server.server.port());
  absolute.send("GET http://rebound.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(absolute.receive().find("wrong_host"), std::string::npos);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
