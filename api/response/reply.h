#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/response/plan_outcome.h"

namespace fleetplan::api {

inline constexpr const char* kJson = "application/json";
inline constexpr const char* kProblemJson = "application/problem+json";

/// What goes back to the client; no sockets here.
struct Reply {
  int status = 200;
  std::string content_type = kJson;
  std::string body;

  // For those who watch the service, not for the client.
  std::string_view problem = {};  // the error's code, e.g. "not_found"; empty: none
  std::optional<PlanOutcome> outcome = std::nullopt;
};

}  // namespace fleetplan::api
