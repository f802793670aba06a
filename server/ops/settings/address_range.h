#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace fleetplan::server {

/// An IP address; one of IPv4 as IPv6 maps it.
using IpAddress = std::array<std::uint8_t, 16>;

/// Without a port. None when it is not an address.
std::optional<IpAddress> ip_address(const std::string& text);

/// Addresses with the same first bits.
class AddressRange {
 public:
  /// An address, or an address with the number of bits after a slash: 10.0.0.0/8.
  static std::optional<AddressRange> from_text(const std::string& text);

  bool contains(const IpAddress& address) const;

 private:
  AddressRange(const IpAddress& first, unsigned bits) : first_(first), bits_(bits) {}

  IpAddress first_;
  unsigned bits_;
};

}  // namespace fleetplan::server
