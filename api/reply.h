#pragma once

#include <string>

namespace fleetplan::api {

inline constexpr const char* kJson = "application/json";
inline constexpr const char* kProblemJson = "application/problem+json";

/// What goes back to the client; no sockets here.
struct Reply {
  int status = 200;
  std::string content_type = kJson;
  std::string body;
};

}  // namespace fleetplan::api
