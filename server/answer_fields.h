#pragma once

#include "server/exchange.h"

namespace fleetplan::server {

/// The header fields of every answer, whoever writes it.
HeaderFields common_fields(const Exchange& exchange);

}  // namespace fleetplan::server
