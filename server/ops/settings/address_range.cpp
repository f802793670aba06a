#include "server/ops/settings/address_range.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>

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

}  // namespace fleetplan::server
