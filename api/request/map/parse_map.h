#pragma once

// Maps of requests: where they lie in the world, the kinds in which they are given, and their zones.

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

/// The map of a request and where it lies in the world.
struct WorldMap {
  core::OccupancyGrid grid;
  WorldFrame frame;
  RasterPose pose;                    // of the raster that it was made of
  std::vector<std::string> warnings;  // about cells that may not mean what they are read as
};

/// Reads the member `map`, which has one of `rows`, `occupancy_grid`, `image` and `movingai`: a map of at
/// most `max_cells` cells. Returns none when it has a fault or when the reading of the document is stopped.
std::optional<WorldMap> parse_map(const JsonReader& member, std::int64_t max_cells);

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

/// Reads a map with the member `rows`: strings from the top, `.` and `G` free, `#`, `@`, `O`, `T`, `W`
/// blocked. Returns none when it has a fault.
std::optional<WorldMap> parse_rows_map(const JsonReader& map, std::int64_t max_cells);

/// Reads a map with the member `movingai`: the text of a `.map` file of the MovingAI benchmarks. Free are
/// `.`, `G` and `S`; blocked `@`, `O`, `T`, `W` and `#`. Returns none when it has a fault.
std::optional<WorldMap> parse_movingai_map(const JsonReader& map, std::int64_t max_cells);

// The functions below read maps of occupancy, as ROS has them: cells of 65 % and more are blocked, cells of
// up to 25 % free, and the others unknown, which the member `unknown` of the map makes "blocked" (the
// default) or "free". The maps have at most `max_cells` cells. The functions return none when a map has a
// fault or when the reading of the document is stopped.

/// Reads a map with the member `occupancy_grid`: a message of the type nav_msgs/OccupancyGrid.
std::optional<WorldMap> parse_occupancy_grid_map(const JsonReader& map, std::int64_t max_cells);

/// Reads a map with the member `image`: an image and the members of its map.yaml.
std::optional<WorldMap> parse_image_map(const JsonReader& map, std::int64_t max_cells);

/// The robots that zones may name: those of the request, or also others, which are not there.
enum class ZoneRobots { of_request, also_others };

/// Reads `zones` (may be absent), in the frame of the map; those with a fault are left out. Their robots are
/// indices into `robots`; one that is not there has the first index that is none. A mask becomes several
/// zones of one id, which follow each other. Without a map (null), masks are not read. `warnings` gets those
/// about masks.
std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldMap* map, const Limits& limits,
                                    const std::vector<ParsedRobot>& robots,
                                    std::vector<std::string>& warnings,
                                    ZoneRobots named = ZoneRobots::of_request);

}  // namespace fleetplan::api
