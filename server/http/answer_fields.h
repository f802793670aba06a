#pragma once

#include "server/http/exchange.h"
#include "server/http/header_fields.h"

namespace fleetplan::server {

/// The header fields of every answer, whoever writes it.
HeaderFields common_fields(const Exchange& exchange);

}  // namespace fleetplan::server
