#include "server/jobs/client_of.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>

namespace fleetplan::server {

namespace {

constexpr std::ptrdiff_t kNetworkBytes = 8;

/// An IPv6 address without brackets as its network; of an IPv4 address in IPv6's notation, that address.
std::string network_of(const std::string& address) {
  in6_addr binary{};
  if (::inet_pton(AF_INET6, address.substr(0, address.find('%')).c_str(), &binary) != 1) return address;
  if (IN6_IS_ADDR_V4MAPPED(&binary)) return address.substr(address.rfind(':') + 1);
  std::fill(std::begin(binary.s6_addr) + kNetworkBytes, std::end(binary.s6_addr), std::uint8_t{0});
  std::array<char, INET6_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET6, &binary, text.data(), text.size());
}

}  // namespace

std::string client_of(const Exchange& exchange) { return client_of_peer(exchange.socket->peer()); }

std::string client_of_peer(const std::string& peer) {
  const std::string host = peer.substr(0, peer.rfind(':'));
  if (!host.starts_with('[')) return host;
  return network_of(host.substr(1, host.size() - 2));
}

}  // namespace fleetplan::server
