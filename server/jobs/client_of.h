#pragma once

#include <string>
#include <vector>

#include "server/ops/settings/address_range.h"

namespace fleetplan::server {

/// The client that sent a request, as far as shares of the server are concerned: its address, of IPv6 the
/// network of 64 bits, which one client may use alone. Behind trusted proxies, it is the last address that
/// they forwarded and that is not a trusted proxy itself.
///
/// `peer`: see Socket::peer. `forwarded`: the values of X-Forwarded-For.
std::string client_of(const std::string& peer, const std::string& forwarded,
                      const std::vector<AddressRange>& trusted_proxies);

}  // namespace fleetplan::server
