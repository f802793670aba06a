#pragma once

// The address of a client, also behind proxies that an operator trusts.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fleetplan::server {

/// An IP address; one of IPv4 as IPv6 maps it.
using IpAddress = std::array<std::uint8_t, 16>;

/// Reads an address without a port. Returns none when the text is not an address.
std::optional<IpAddress> ip_address(const std::string& text);

/// Addresses with the same first bits.
class AddressRange {
 public:
  /// Reads an address, or an address with the number of bits after a slash: 10.0.0.0/8.
  static std::optional<AddressRange> from_text(const std::string& text);

  bool contains(const IpAddress& address) const;

 private:
  AddressRange(const IpAddress& first, unsigned bits) : first_(first), bits_(bits) {}

  IpAddress first_;
  unsigned bits_;
};

/// Returns the client that sent a request, as far as shares of the server are concerned: its address, or for
/// IPv6 the network of 64 bits, which one client may use alone. Behind trusted proxies, it is the last
/// address that they forwarded and that is not a trusted proxy itself.
///
/// `peer`: see Socket::peer. `forwarded`: the values of X-Forwarded-For.
std::string client_of(const std::string& peer, const std::string& forwarded,
                      const std::vector<AddressRange>& trusted_proxies);

}  // namespace fleetplan::server
