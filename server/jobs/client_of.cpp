#include "server/jobs/client_of.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <string_view>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

constexpr std::ptrdiff_t kNetworkBytes = 8;

/// Of `192.0.2.7:80`, `192.0.2.7`, `[2001:db8::1]:80`, `[2001:db8::1]` or `2001:db8::1%eth0`.
std::string without_port(std::string_view text) {
  if (text.starts_with('[')) {
    text = text.substr(1, text.find(']') - 1);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    text = text.substr(0, text.find(':'));
  }
  return std::string(text.substr(0, text.find('%')));
}

bool is_ipv4(IpAddress address) {
  in6_addr binary{};
  std::copy(address.begin(), address.end(), std::begin(binary.s6_addr));
  return IN6_IS_ADDR_V4MAPPED(&binary);
}

std::string name_of(IpAddress address) {
  if (!is_ipv4(address)) std::fill(address.begin() + kNetworkBytes, address.end(), std::uint8_t{0});
  std::array<char, INET6_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET6, address.data(), text.data(), text.size());
}

}  // namespace

std::string client_of(const std::string& peer, const std::string& forwarded,
                      const std::vector<AddressRange>& trusted_proxies) {
  const auto trusted = [&](const IpAddress& address) {
    return std::any_of(trusted_proxies.begin(), trusted_proxies.end(),
                       [&](const AddressRange& range) { return range.contains(address); });
  };
  auto client = ip_address(without_port(peer));
  if (!client) return peer;
  std::string_view rest = forwarded;
  while (trusted(*client) && !rest.empty()) {
    const auto comma = rest.rfind(',');
    const auto last = comma == std::string_view::npos ? rest : rest.substr(comma + 1);
    const auto before = ip_address(without_port(trimmed(last)));
    if (!before) break;
    client = before;
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(0, comma);
  }
  return name_of(*client);
}

}  // namespace fleetplan::server
