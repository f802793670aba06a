#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/error.h"
#include "server/request_head.h"
#include "server/routes.h"
#include "server/static_files.h"

namespace fleetplan::server {

/// Why a request is not served.
struct Refusal {
  api::ErrorCode code;
  std::string detail;
  std::vector<std::pair<std::string, std::string>> fields = {};  // further header fields
};

/// Everything that can be decided by the head alone, before a byte of the body is read: 404, 405, 406, 413,
/// 415 and 503 while draining.
std::variant<Route, Refusal> admit(const RequestHead& head, const StaticFiles& files, std::uint64_t max_body,
                                   bool draining);

}  // namespace fleetplan::server
