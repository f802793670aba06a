#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/exchange.h"

namespace fleetplan::server {

using HeaderFields = std::vector<std::pair<std::string, std::string>>;

/// The header fields of every answer, whoever writes it.
HeaderFields common_fields(const Exchange& exchange);

}  // namespace fleetplan::server
