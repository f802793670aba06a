#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// The authority of a URI without user information (RFC 3986, 3.2): `host[:port]`.
struct Authority {
  std::string host;  // in lower case; an IPv6 address with its brackets
  std::string port;  // digits; empty: that of the scheme
};

/// None when it is malformed or has no host.
std::optional<Authority> parse_authority(std::string_view text);

/// True for names of this machine alone: localhost, 127.0.0.0/8 and ::1, the last with or without brackets.
bool is_local_name(std::string_view host);

}  // namespace fleetplan::server
