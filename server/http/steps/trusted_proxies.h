#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::server {

/// The proxies whose X-Forwarded-For is believed. Clients of others can write in that field what they like.
class TrustedProxies {
 public:
  /// Of IPv6; an IPv4 address is in its notation as ::ffff:a.b.c.d.
  using Address = std::array<std::uint8_t, 16>;

  /// `networks`: IPv4 or IPv6 addresses, each perhaps with its number of leading bits, such as 10.0.0.0/8.
  /// Those that network_fault() rejects are ignored.
  explicit TrustedProxies(const std::vector<std::string>& networks);

  /// The address of the client that sent a request, without its port: the peer, or, if that is trusted, the
  /// last address in `forwarded` that is not. `peer`: see Socket::peer. `forwarded`: the field
  /// X-Forwarded-For, to the end of which each proxy adds the address that it got the request from.
  std::string client_of(std::string_view peer, std::string_view forwarded) const;

 private:
  struct Network {
    Address address;
    unsigned bits;
  };

  static std::optional<Network> parse(std::string_view network);
  friend std::optional<std::string> network_fault(std::string_view network);
  bool trusts(const Address& address) const;

  std::vector<Network> networks_;
};

/// Why TrustedProxies ignores this network; none when it does not.
std::optional<std::string> network_fault(std::string_view network);

}  // namespace fleetplan::server
