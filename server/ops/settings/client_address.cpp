#include "server/ops/settings/client_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

constexpr unsigned kBits = 128;
constexpr unsigned kBitsBeforeIpv4 = 96;

std::optional<unsigned> number(const std::string& text) {
  unsigned value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<IpAddress> ip_address(const std::string& text) {
  IpAddress address{};
  if (::inet_pton(AF_INET6, text.c_str(), address.data()) == 1) return address;
  address[10] = address[11] = 0xff;
  if (::inet_pton(AF_INET, text.c_str(), &address[12]) == 1) return address;
  return std::nullopt;
}

std::optional<AddressRange> AddressRange::from_text(const std::string& text) {
  const auto slash = text.find('/');
  const auto first = ip_address(text.substr(0, slash));
  if (!first) return std::nullopt;
  if (slash == std::string::npos) return AddressRange(*first, kBits);
  const unsigned before = text.find(':') == std::string::npos ? kBitsBeforeIpv4 : 0;
  const auto bits = number(text.substr(slash + 1));
  if (!bits || *bits > kBits - before) return std::nullopt;
  return AddressRange(*first, before + *bits);
}

bool AddressRange::contains(const IpAddress& address) const {
  const auto whole = static_cast<std::ptrdiff_t>(bits_ / 8);
  if (!std::equal(first_.begin(), first_.begin() + whole, address.begin())) return false;
  const unsigned rest = bits_ % 8;
  if (rest == 0) return true;
  const auto at = static_cast<std::size_t>(whole);
  return (first_[at] ^ address[at]) >> (8 - rest) == 0;
}

namespace {

constexpr std::ptrdiff_t kNetworkBytes = 8;

/// Returns the host of `192.0.2.7:80`, `192.0.2.7`, `[2001:db8::1]:80`, `[2001:db8::1]` or
/// `2001:db8::1%eth0`.
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
