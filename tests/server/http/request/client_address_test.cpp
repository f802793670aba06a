
#include <gtest/gtest.h>

#include "server/http/request/access.h"

namespace fleetplan::server {
namespace TEST_FILE {

std::vector<AddressRange> ranges(const std::vector<std::string>& texts) {
  std::vector<AddressRange> result;
  for (const auto& text : texts) result.push_back(AddressRange::from_text(text).value());
  return result;
}

std::string client_of_peer(const std::string& peer) { return client_of(peer, "", {}); }

TEST(ClientOf, IsTheAddressWithoutThePort) {
  EXPECT_EQ(client_of_peer("192.0.2.7:40310"), client_of_peer("192.0.2.7:2"));
  EXPECT_NE(client_of_peer("192.0.2.7:40310"), client_of_peer("192.0.2.8:40310"));
  EXPECT_EQ(client_of_peer(""), "");
}

TEST(ClientOf, IsTheNetworkOfAnIpv6Address) {
  EXPECT_EQ(client_of_peer("[2001:db8:1:2:3:4:5:6]:80"), "2001:db8:1:2::");
  EXPECT_EQ(client_of_peer("[2001:db8:1:2::9]:80"), "2001:db8:1:2::");
  EXPECT_EQ(client_of_peer("[fe80::9%eth0]:80"), "fe80::");
  EXPECT_NE(client_of_peer("[2001:db8:1:3::9]:80"), "2001:db8:1:2::");
}

TEST(ClientOf, IsTheIpv4AddressThatIpv6Carries) {
  EXPECT_EQ(client_of_peer("[::ffff:192.0.2.7]:80"), client_of_peer("192.0.2.7:90"));
}

TEST(ClientOf, IsTheAddressThatATrustedProxyForwards) {
  const auto proxies = ranges({"10.0.0.0/8", "2001:db8::/32"});
  const std::string client = client_of_peer("192.0.2.7:1");
  EXPECT_EQ(client_of("10.1.2.3:5", "192.0.2.7", proxies), client);
  EXPECT_EQ(client_of("[2001:db8::7]:5", "192.0.2.7", proxies), client);
  EXPECT_EQ(client_of("10.1.2.3:5", "198.51.100.1, 192.0.2.7", proxies), client)
      << "the first may be made up";
  EXPECT_EQ(client_of("10.1.2.3:5", "198.51.100.1, 192.0.2.7:99, 10.9.9.9", proxies), client);
  EXPECT_EQ(client_of("10.1.2.3:5", "unknown", proxies), client_of_peer("10.1.2.3:5"));
  EXPECT_EQ(client_of("192.0.2.7:5", "198.51.100.1", proxies), client) << "not a trusted proxy";
}

TEST(AddressRange, ComparesBits) {
  const auto range = AddressRange::from_text("10.32.0.0/11").value();
  EXPECT_TRUE(range.contains(ip_address("10.63.255.255").value()));
  EXPECT_FALSE(range.contains(ip_address("10.64.0.0").value()));
  EXPECT_TRUE(AddressRange::from_text("::1").value().contains(ip_address("::1").value()));
  EXPECT_TRUE(AddressRange::from_text("0.0.0.0/0").value().contains(ip_address("8.8.8.8").value()));
}

TEST(AddressRange, RejectsWhatIsNone) {
  for (const char* text : {"", "10.0.0", "10.0.0.0/33", "10.0.0.0/", "::/129", "10.0.0.0/-1", "localhost"}) {
    EXPECT_FALSE(AddressRange::from_text(text)) << text;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
