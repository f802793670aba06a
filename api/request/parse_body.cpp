#include "api/request/parse_body.h"

#include <string>

namespace fleetplan::api {

namespace {

constexpr std::size_t kMostListed = 100;

ErrorCode code_of(JsonError::Kind kind) {
  switch (kind) {
    case JsonError::Kind::malformed:
      return ErrorCode::malformed_json;
    case JsonError::Kind::too_deep:
      return ErrorCode::too_deep;
    case JsonError::Kind::too_large:
      break;
  }
  return ErrorCode::invalid_request;
}

}  // namespace

RequestError request_error(const FaultList& faults) {
  RequestError error;
  error.faults = faults.first(kMostListed);
  if (faults.count() == 1) {
    error.detail = error.faults.front().detail;
  } else if (faults.count() == error.faults.size()) {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; see errors.";
  } else {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; errors lists the first " +
                   std::to_string(error.faults.size()) + ".";
  }
  return error;
}

RequestError request_error(const JsonError& error) {
  RequestError request{code_of(error.kind), error.detail, {}};
  if (request.code == ErrorCode::invalid_request) {
    request.faults.push_back({"", fault::kOutOfRange, error.detail});
  }
  return request;
}

Fleet parse_fleet(const JsonReader& root, const Limits& limits) {
  Fleet fleet;
  fleet.map = parse_map(root.require("map"), limits.max_cells);
  const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
  fleet.robots = parse_robots(root.require("robots"), root.find("robot_defaults"), frame, limits.max_robots);
  fleet.options = parse_options(root.find("options"));
  return fleet;
}

}  // namespace fleetplan::api
