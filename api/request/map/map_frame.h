#pragma once

// What all kinds of maps have in common: their size, and where they lie.

#include <cstdint>
#include <optional>

#include "api/json/json_reader.h"
#include "api/request/world_frame.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::api {

/// The map of a request and where it lies in the world.
struct WorldMap {
  core::OccupancyGrid grid;
  WorldFrame frame;
};

/// Members `resolution` and `origin` {x, y} of a map; 1 m and (0, 0) if they are not there.
struct MapFrame {
  double resolution = 1.0;
  WorldFrame frame;
};

MapFrame parse_map_frame(const JsonReader& map);

/// Reports a fault at the place if the map has more cells than this. The sizes are below 2^32.
bool check_cells(const JsonReader& place, std::uint64_t columns, std::uint64_t rows, std::int64_t max_cells);

/// Reports a fault at the place if the map is larger than the ranges of coordinates and speeds are made for.
bool check_extent(const JsonReader& place, double columns, double rows, double resolution);

}  // namespace fleetplan::api
