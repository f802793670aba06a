#pragma once

// Maps of requests: their position in the world, the kinds in which they are given, and their zones.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/map/raster_place.h"
#include "api/request/shared_members.h"
#include "core/map/occupancy_grid.h"
#include "core/model/surroundings.h"

namespace fleetplan::api {

struct ParsedRobot;

/// The map of a request and its position in the world.
struct WorldMap {
  core::OccupancyGrid grid;
  WorldFrame frame;
  RasterPose pose;                    // of the raster that it was made of
  std::vector<std::string> warnings;  // about cells that may not mean what they are read as
};

/// Reads the member `map`, which has one of `rows`, `occupancy_grid`, `image` and `movingai`. The map may
/// have at most `max_cells` cells. Returns none if it has a fault, or if the reading of the document is
/// stopped.
std::optional<WorldMap> parse_map(const JsonReader& member, std::int64_t max_cells);

/// Members `resolution` and `origin` {x, y} of a map; 1 m and (0, 0) if they are not there.
struct MapFrame {
  double resolution = 1.0;
  WorldFrame frame;
};

MapFrame parse_map_frame(const JsonReader& map);

/// Reports a fault at the place if the map has more cells than this. The sizes are below 2^32.
bool check_cells(const JsonReader& place, std::uint64_t columns, std::uint64_t rows, std::int64_t max_cells);

/// Reports a fault at the place if the map is too large for the ranges of coordinates and speeds.
bool check_extent(const JsonReader& place, double columns, double rows, double resolution);

/// Reads a map with the member `rows`: strings from the top. `.` and `G` are free; `#`, `@`, `O`, `T`, `W`
/// blocked. Returns none if it has a fault.
std::optional<WorldMap> parse_rows_map(const JsonReader& map, std::int64_t max_cells);

/// Reads a map with the member `movingai`: the text of a `.map` file of the MovingAI benchmarks. `.`, `G` and
/// `S` are free; `@`, `O`, `T`, `W` and `#` blocked. Returns none if it has a fault.
std::optional<WorldMap> parse_movingai_map(const JsonReader& map, std::int64_t max_cells);

// The functions below read maps of occupancy, as in ROS. Cells of 65 % and more are blocked, cells of up to
// 25 % are free, and the others are unknown. The member `unknown` of the map makes unknown cells "blocked"
// (the default) or "free". The maps have at most `max_cells` cells. The functions return none if a map has a
// fault, or if the reading of the document is stopped.

/// Reads a map with the member `occupancy_grid`: a message of the type nav_msgs/OccupancyGrid.
std::optional<WorldMap> parse_occupancy_grid_map(const JsonReader& map, std::int64_t max_cells);

/// Reads a map with the member `image`: an image and the members of its map.yaml.
std::optional<WorldMap> parse_image_map(const JsonReader& map, std::int64_t max_cells);

/// The robots that zones may name: only robots of the request, or also robots that are not there.
enum class ZoneRobots { of_request, also_others };

/// Reads `zones` (may be absent), in the frame of the map. Zones with a fault are left out. Their robots are
/// indices into `robots`. A robot that is not there gets the first index past the last robot.
///
/// A mask becomes several zones with the same id, which follow each other. Without a map (null), masks are
/// not read. `warnings` receives warnings about masks.
std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldMap* map, const Limits& limits,
                                    const std::vector<ParsedRobot>& robots,
                                    std::vector<std::string>& warnings,
                                    ZoneRobots named = ZoneRobots::of_request);

}  // namespace fleetplan::api
