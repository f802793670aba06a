#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fleetplan::server {

/// Names and values of an answer's header fields, in their order; a name may come several times.
using HeaderFields = std::vector<std::pair<std::string, std::string>>;

}  // namespace fleetplan::server
