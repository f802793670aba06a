#include "server/http/guard/authority.h"

#include <gtest/gtest.h>

namespace fleetplan::server {
namespace TEST_FILE {

TEST(Authority, IsAHostInLowerCaseWithAnOptionalPort) {
  const auto name = parse_authority("Fleet.Example:8080");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->host, "fleet.example");
  EXPECT_EQ(name->port, "8080");
  const auto address = parse_authority("[::1]");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->host, "[::1]");
  EXPECT_EQ(address->port, "");
}

TEST(Authority, ThatIsMalformedIsNone) {
  for (const char* text : {"", ":80", "a b", "a/b", "user@a", "a:b", "a:123456", "[::1", "[::1]80", "[]",
                           "[a]", "::1", "a,b c", "\xff"}) {
    EXPECT_EQ(parse_authority(text), std::nullopt) << text;
  }
}

TEST(LocalName, IsLocalhostOrALoopbackAddress) {
  for (const char* host : {"localhost", "LocalHost", "127.0.0.1", "127.8.9.10", "::1", "[::1]", "[0:0::1]"}) {
    EXPECT_TRUE(is_local_name(host)) << host;
  }
  for (const char* host :
       {"", "0.0.0.0", "::", "128.0.0.1", "localhost.example", "127.0.0.1.example", "127.1", "[::2]"}) {
    EXPECT_FALSE(is_local_name(host)) << host;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
