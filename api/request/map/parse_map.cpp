#include "api/request/map/parse_map.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "api/request/map/movingai_map.h"
#include "api/request/map/raster_map.h"
#include "api/request/map/rows_map.h"

namespace fleetplan::api {

namespace {

using Parse = std::optional<WorldMap> (*)(const JsonReader& map, std::int64_t max_cells);

struct Kind {
  std::string_view name;  // of the member that makes a map one of this kind
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
