#pragma once

#include <cstdint>
#include <optional>

#include "api/json/json_reader.h"
#include "api/request/map/map_frame.h"

namespace fleetplan::api {

/// A map with the member `movingai`: the text of a `.map` file of the MovingAI benchmarks. Free are `.`, `G`
/// and `S`; blocked `@`, `O`, `T`, `W` and `#`. Nothing when it has a fault.
std::optional<WorldMap> parse_movingai_map(const JsonReader& map, std::int64_t max_cells);

}  // namespace fleetplan::api
