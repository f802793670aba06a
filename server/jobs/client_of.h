#pragma once

#include <string>

#include "server/http/exchange.h"

namespace fleetplan::server {

/// The client that sent the request, as far as shares of the server are concerned: its address, of IPv6 the
/// network of 64 bits, which one client may use alone.
std::string client_of(const Exchange& exchange);

/// Of an address with its port, see Socket::peer.
std::string client_of_peer(const std::string& peer);

}  // namespace fleetplan::server
