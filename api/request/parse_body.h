#pragma once

// The parts that requests share: reading the body, and the map, the robots, the obstacles and the options in
// it.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/options.h"
#include "api/request/shared_members.h"
#include "core/model/surroundings.h"

namespace fleetplan::api {

/// Reads `obstacles` (may be absent), in the map frame. Motion before t = 0 is cut off. An obstacle that is
/// gone by then is left out. `ids` has the ids of the robots.
std::vector<core::MovingObstacle> parse_obstacles(const JsonReader& member, const WorldFrame& frame,
                                                  const Limits& limits, UniqueIds& ids);

/// `map`, `robots` (with `robot_defaults`), `obstacles`, `zones` and `options` of a request, as far as they
/// could be read.
struct Fleet {
  std::optional<WorldMap> map;
  std::vector<ParsedRobot> robots;
  std::vector<core::MovingObstacle> obstacles;
  std::vector<core::Zone> zones;  // their robots are indices into `robots`
  ParsedOptions options;
  std::string metadata;  // see parse_metadata
};

/// Returns which dependencies are requested. A robot without its own margin has the margin of the options.
RequestedDependencies requested_dependencies(const Fleet& fleet);

/// Reads the fleet from the root of the document. `set_budget` receives the options, which are read first.
/// `given`, which may be null, remembers positions for the frame of the map, see WorldFrame.
Fleet parse_fleet(const JsonReader& root, const Limits& limits,
                  const std::function<void(const ParsedOptions&)>& set_budget,
                  GivenPositions* given = nullptr);

/// Reports a lattice with too many vertices, or without any. `options` is the member of the request.
void check_lattice(const JsonReader& options, const core::PlanOptions& plan, const core::OccupancyGrid& grid,
                   const Limits& limits);

RequestError request_error(const JsonError& error, const core::Work& work);
/// Returns the error with the listed faults and the number of all faults. There must be at least one.
RequestError request_error(const FaultList& faults);

/// Returns the error of a request whose reading was stopped.
RequestError unfinished(const core::Work& work);

/// Reads a body whose root has these members. Returns the request if the document has no fault at all.
/// `parse` gets a reader of the root and the work, whose budget it may set. It returns an optional request,
/// which is empty only if it reported faults or if the work was met.
template <typename Request, typename Parse>
Result<Request, RequestError> parse_body(std::string_view body, const Limits& limits, core::Work& work,
                                         std::span<const std::string_view> members, const Parse& parse) {
  auto document = read_json(body, limits.max_depth, work);
  if (!document) return request_error(document.failure(), work);
  std::optional<Request> request = parse(JsonReader(*document).object(members), work);
  const bool ended = !request && document->faults.empty();
  if (ended || work.met()) return unfinished(work);
  if (!document->faults.empty()) return request_error(document->faults);
  return std::move(*request);
}

}  // namespace fleetplan::api
