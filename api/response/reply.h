#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/response/plan_outcome.h"

namespace fleetplan::api {

inline constexpr const char* kJson = "application/json";
inline constexpr const char* kProblemJson = "application/problem+json";

/// An answer to a client, without any socket.
struct Reply {
  int status = 200;
  std::string content_type = kJson;
  std::string body;

  // For metrics and the log, not for the client.
  std::string_view problem = {};  // the error's code, e.g. "not_found"; empty: none
  std::optional<PlanOutcome> outcome = std::nullopt;

  /// What was needed to make the answer, to be freed once it is sent; null: nothing.
  std::shared_ptr<const void> leftovers = nullptr;
};

}  // namespace fleetplan::api
