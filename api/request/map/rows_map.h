#pragma once

#include <cstdint>
#include <optional>

#include "api/json/json_reader.h"
#include "api/request/map/map_frame.h"

namespace fleetplan::api {

/// A map with the member `rows`: strings from the top, `.` and `G` free, `#`, `@`, `O`, `T`, `W` blocked.
/// Nothing when it has a fault.
std::optional<WorldMap> parse_rows_map(const JsonReader& map, std::int64_t max_cells);

}  // namespace fleetplan::api
