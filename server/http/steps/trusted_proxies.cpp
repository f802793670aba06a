#include "server/http/steps/trusted_proxies.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

using Address = TrustedProxies::Address;

constexpr unsigned kBits = 128;
constexpr unsigned kMappedBits = 96;  // before an IPv4 address in IPv6

std::optional<Address> parse_address(const std::string& text) {
  Address address{};
  if (::inet_pton(AF_INET6, text.c_str(), address.data()) == 1) return address;
  address = {};
  address[10] = address[11] = 0xff;
  if (::inet_pton(AF_INET, text.c_str(), address.data() + kMappedBits / 8) == 1) return address;
  return std::nullopt;
}

/// Without a port, and without the brackets that IPv6 has then.
std::string without_port(std::string_view text) {
  if (text.starts_with('[')) return std::string(text.substr(1, text.find(']') - 1));
  const auto colon = text.find(':');
  const bool has_port =
      colon != std::string_view::npos && text.find(':', colon + 1) == std::string_view::npos;
  return std::string(has_port ? text.substr(0, colon) : text);
}

bool share_bits(const Address& one, const Address& other, unsigned bits) {
  const unsigned bytes = bits / 8;
  if (!std::equal(one.begin(), one.begin() + bytes, other.begin())) return false;
  const unsigned rest = bits % 8;
  return rest == 0 || ((one[bytes] ^ other[bytes]) >> (8 - rest)) == 0;
}

/// Takes the last part off a list that is separated by commas.
std::string_view take_last(std::string_view& list) {
  const auto comma = list.rfind(',');
  const auto last = comma == std::string_view::npos ? list : list.substr(comma + 1);
  list = comma == std::string_view::npos ? std::string_view() : list.substr(0, comma);
  return trimmed(last);
}

}  // namespace

TrustedProxies::TrustedProxies(const std::vector<std::string>& networks) {
  for (const std::string& network : networks) {
    if (const auto parsed = parse(network)) networks_.push_back(*parsed);
  }
}

std::optional<TrustedProxies::Network> TrustedProxies::parse(std::string_view network) {
  const auto slash = network.find('/');
  const std::string host(network.substr(0, slash));
  const auto address = parse_address(host);
  if (!address) return std::nullopt;
  if (slash == std::string_view::npos) return Network{*address, kBits};
  const unsigned before = host.find(':') == std::string::npos ? kMappedBits : 0;
  const auto digits = network.substr(slash + 1);
  unsigned bits = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
  if (error != std::errc{} || end != digits.data() + digits.size() || bits > kBits - before) {
    return std::nullopt;
  }
  return Network{*address, before + bits};
}

std::string TrustedProxies::client_of(std::string_view peer, std::string_view forwarded) const {
  std::string client = without_port(peer);
  while (!forwarded.empty()) {
    const auto address = parse_address(client);
    if (!address || !trusts(*address)) break;
    std::string before = without_port(take_last(forwarded));
    if (!parse_address(before)) break;
    client = std::move(before);
  }
  return client;
}

bool TrustedProxies::trusts(const Address& address) const {
  return std::any_of(networks_.begin(), networks_.end(), [&](const Network& network) {
    return share_bits(address, network.address, network.bits);
  });
}

std::optional<std::string> network_fault(std::string_view network) {
  if (TrustedProxies::parse(network)) return std::nullopt;
  return in_quotes(network) + " is not an address such as 192.0.2.7, nor a network such as 10.0.0.0/8";
}

}  // namespace fleetplan::server
