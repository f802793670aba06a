#include "server/http/steps/trusted_proxies.h"

#include <gtest/gtest.h>

namespace fleetplan::server {
namespace {

const TrustedProxies kNone({});
const TrustedProxies kPrivate({"10.0.0.0/8", "192.168.7.9", "fd00::/8"});

TEST(TrustedProxies, LeaveTheClientThatThePeerIs) {
  EXPECT_EQ(kPrivate.client_of("192.0.2.7:5000", ""), "192.0.2.7");
  EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", ""), "10.1.2.3");
  EXPECT_EQ(kPrivate.client_of("[2001:db8::1]:5000", ""), "2001:db8::1");
}

TEST(TrustedProxies, AreTheOnlyOnesThatMayNameAnotherClient) {
  EXPECT_EQ(kNone.client_of("10.1.2.3:5000", "192.0.2.7"), "10.1.2.3");
  EXPECT_EQ(kPrivate.client_of("11.1.2.3:5000", "192.0.2.7"), "11.1.2.3");
  EXPECT_EQ(kPrivate.client_of("192.168.7.8:5000", "192.0.2.7"), "192.168.7.8");
  EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", "192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(kPrivate.client_of("192.168.7.9:5000", "192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(kPrivate.client_of("[fd12::1]:5000", "2001:db8::1"), "2001:db8::1");
  EXPECT_EQ(kPrivate.client_of("[fe80::1]:5000", "2001:db8::1"), "fe80::1");
}

TEST(TrustedProxies, AreSkippedUpToTheLastAddressThatIsNotTrusted) {
  EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", "198.51.100.1, 192.0.2.7,10.9.9.9"), "192.0.2.7");
  EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", "10.0.0.1, 10.0.0.2"), "10.0.0.1");
}

TEST(TrustedProxies, MayForwardPorts) {
  EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", "192.0.2.7:40000"), "192.0.2.7");
  EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", "[2001:db8::1]:40000"), "2001:db8::1");
}

TEST(TrustedProxies, AreTheClientIfTheyForwardNoAddress) {
  for (const char* forwarded : {"unknown", "192.0.2.7, unknown", ",", "192.0.2.256", "[", "[]:1"}) {
    EXPECT_EQ(kPrivate.client_of("10.1.2.3:5000", forwarded), "10.1.2.3") << forwarded;
  }
}

TEST(TrustedProxies, OfIPv4AreRecognizedInIPv6) {
  EXPECT_EQ(kPrivate.client_of("[::ffff:10.1.2.3]:5000", "192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(kPrivate.client_of("[::ffff:11.1.2.3]:5000", "192.0.2.7"), "::ffff:11.1.2.3");
}

TEST(TrustedProxies, AreComparedByTheirLeadingBits) {
  const TrustedProxies odd({"172.16.0.0/12"});
  EXPECT_EQ(odd.client_of("172.31.255.255:1", "192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(odd.client_of("172.32.0.0:1", "192.0.2.7"), "172.32.0.0");
  const TrustedProxies all({"0.0.0.0/0"});
  EXPECT_EQ(all.client_of("203.0.113.9:1", "192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(all.client_of("[2001:db8::1]:1", "192.0.2.7"), "2001:db8::1");
}

TEST(TrustedProxies, AreAddressesOrNetworks) {
  for (const char* network : {"192.0.2.7", "10.0.0.0/8", "::1", "fd00::/8", "0.0.0.0/0", "::/0", "::1/128"}) {
    EXPECT_EQ(network_fault(network), std::nullopt) << network;
  }
  for (const char* other : {"", "proxy", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1", "10.0.0.0/8x", "10.0.0/8",
                            "fd00::/129", "/8"}) {
    EXPECT_NE(network_fault(other), std::nullopt) << other;
  }
}

}  // namespace
}  // namespace fleetplan::server
