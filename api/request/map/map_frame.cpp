#include "api/request/map/map_frame.h"

#include <array>
#include <string>
#include <string_view>

#include "api/json/faults.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 2> kOriginMembers{"x", "y"};

}  // namespace

MapFrame parse_map_frame(const JsonReader& map) {
  const double resolution = map.find("resolution").number(kLength).value_or(1.0);
  const JsonReader origin = map.find("origin").object(kOriginMembers);
  const double x = origin.require("x").number(kCoordinate).value_or(0.0);
  const double y = origin.require("y").number(kCoordinate).value_or(0.0);
  return {resolution, {{x, y}}};
}

bool check_cells(const JsonReader& place, std::uint64_t columns, std::uint64_t rows, std::int64_t max_cells) {
  const std::uint64_t cells = columns * rows;
  if (cells <= static_cast<std::uint64_t>(max_cells)) return true;
  place.fault(fault::kOutOfRange, "The map has " + std::to_string(columns) + " x " + std::to_string(rows) +
                                      " = " + std::to_string(cells) +
                                      " cells; this service accepts at most " + std::to_string(max_cells) +
                                      ". Use a coarser resolution or a part of the map.");
  return false;
}

bool check_extent(const JsonReader& place, double columns, double rows, double resolution) {
  const double width = columns * resolution;
  const double height = rows * resolution;
  if (width <= kLargestExtent && height <= kLargestExtent) return true;
  place.fault(fault::kOutOfRange, "The map is " + number_text(width) + " m x " + number_text(height) +
                                      " m; it must be at most " + number_text(kLargestExtent) +
                                      " m in each direction. Use a smaller resolution or a part of the map.");
  return false;
}

}  // namespace fleetplan::api
