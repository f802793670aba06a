#include "server/jobs/client_of.h"

#include <gtest/gtest.h>

namespace fleetplan::server {
namespace {

TEST(ClientOf, IsTheAddressWithoutThePort) {
  EXPECT_EQ(client_of_peer("192.0.2.7:40310"), "192.0.2.7");
  EXPECT_EQ(client_of_peer("192.0.2.7:1"), client_of_peer("192.0.2.7:2"));
  EXPECT_EQ(client_of_peer(""), "");
}

TEST(ClientOf, IsTheNetworkOfAnIpv6Address) {
  EXPECT_EQ(client_of_peer("[2001:db8:1:2:3:4:5:6]:80"), "2001:db8:1:2::");
  EXPECT_EQ(client_of_peer("[2001:db8:1:2::9]:80"), "2001:db8:1:2::");
  EXPECT_NE(client_of_peer("[2001:db8:1:3::9]:80"), "2001:db8:1:2::");
}

TEST(ClientOf, IsTheIpv4AddressThatIpv6Carries) {
  EXPECT_EQ(client_of_peer("[::ffff:192.0.2.7]:80"), "192.0.2.7");
}

}  // namespace
}  // namespace fleetplan::server
