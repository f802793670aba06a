#include "api/request/map/parse_map.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "api/json/faults.h"
#include "api/request/map/map_kinds.h"
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

namespace {

using Parse = std::optional<WorldMap> (*)(const JsonReader& map, std::int64_t max_cells);

struct Kind {
  std::string_view name;  // member that makes a map one of this kind
  std::array<std::string_view, 3> members;
  Parse parse;
};

constexpr std::array<Kind, 4> kMapKinds{{
    {"rows", {"rows", "resolution", "origin"}, parse_rows_map},
    {"occupancy_grid", {"occupancy_grid", "unknown", "unknown"}, parse_occupancy_grid_map},
    {"image", {"image", "unknown", "unknown"}, parse_image_map},
    {"movingai", {"movingai", "resolution", "origin"}, parse_movingai_map},
}};

}  // namespace

std::optional<WorldMap> parse_map(const JsonReader& member, std::int64_t max_cells) {
  const std::size_t before = member.fault_count();
  const Kind* found = nullptr;
  for (const Kind& kind : kMapKinds) {
    const JsonReader given = member.find(kind.name);
    if (!given) continue;
    if (found != nullptr) {
      given.fault(fault::kDuplicate, "The map is given as " + std::string(found->name) + " and as " +
                                         std::string(kind.name) + "; give one of them.");
      return std::nullopt;
    }
    found = &kind;
  }
  const JsonReader map = member.object((found != nullptr ? *found : kMapKinds.front()).members);
  if (found == nullptr) {
    map.require("rows",
                "; give one string for each row, the top one first, or an occupancy_grid, an image or a "
                "movingai map instead");
    return std::nullopt;
  }
  auto made = found->parse(map, max_cells);
  if (member.fault_count() != before) return std::nullopt;
  return made;
}

}  // namespace fleetplan::api
