#include "api/request/parse_fleet.h"

#include <utility>

namespace fleetplan::api {

namespace {

constexpr std::size_t kMostTold = 100;

}  // namespace

RequestError refusal(const FaultList& faults) {
  RequestError error;
  error.faults = faults.first(kMostTold);
  if (faults.count() == 1) {
    error.detail = error.faults.front().detail;
  } else if (faults.count() == error.faults.size()) {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; see errors.";
  } else {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; errors tells the first " +
                   std::to_string(error.faults.size()) + ".";
  }
  return error;
}

RequestError refusal(const JsonError& error) {
  RequestError refused{error.code, error.detail, {}};
  if (error.code == ErrorCode::invalid_request) {
    refused.faults.push_back({"", fault::kOutOfRange, error.detail});
  }
  return refused;
}

Fleet parse_fleet(const ObjectReader& root, const Limits& limits, FaultList& faults) {
  Fleet fleet;
  if (const JsonValue* map = root.require("map")) {
    const JsonPath path = root.path("map");
    fleet.map = parse_map(*map, path, limits.max_cells, faults);
  }
  if (const JsonValue* robots = root.require("robots")) {
    const JsonPath path = root.path("robots");
    const JsonPath defaults_path = root.path("robot_defaults");
    const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
    fleet.robots = parse_robots(*robots, path, root.find("robot_defaults"), defaults_path, frame,
                                limits.max_robots, faults);
  }
  if (const JsonValue* options = root.find("options")) {
    const JsonPath path = root.path("options");
    fleet.options = parse_options(*options, path, faults);
  }
  return fleet;
}

}  // namespace fleetplan::api
