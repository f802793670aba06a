#pragma once

// What lives ask, for scripts/bench --same.

#include <cstdlib>
#include <fstream>
#include <string_view>

#include "tests/api/support/requests.h"

namespace fleetplan::api {

/// Appends a line {"path", "body"} to the file that FLEETPLAN_RECORD names, if it names one.
inline void record(std::string_view path, const Json& body) {
  const char* const file = std::getenv("FLEETPLAN_RECORD");
  if (file == nullptr) return;
  std::ofstream(file, std::ios::app) << Json{{"path", path}, {"body", body}} << '\n';
}

}  // namespace fleetplan::api
