#pragma once

// What all requests share: the map, the robots and the options.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/json/object_reader.h"
#include "api/json/read_json.h"
#include "api/request/limits.h"
#include "api/request/parse_map.h"
#include "api/request/parse_options.h"
#include "api/request/parse_robots.h"
#include "api/response/error.h"

namespace fleetplan::api {

/// Why a request is refused; for problem_reply.
struct RequestError {
  ErrorCode code = ErrorCode::invalid_request;
  std::string detail;
  std::vector<Fault> faults;
};

/// The error that tells all faults (the first hundred one by one). There must be one.
RequestError refusal(const FaultList& faults);
RequestError refusal(const JsonError& error);

/// `map`, `robots` (with `robot_defaults`) and `options` of a request, as far as they could be read.
struct Fleet {
  std::optional<WorldMap> map;
  std::vector<ReadRobot> robots;
  ReadOptions options;
};

/// Reads them from the document's root.
Fleet parse_fleet(const ObjectReader& root, const Limits& limits, FaultList& faults);

}  // namespace fleetplan::api
