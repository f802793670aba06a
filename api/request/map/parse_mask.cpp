#include "api/request/map/parse_mask.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "api/json/errors.h"
#include "api/request/map/image/decode_image.h"
#include "api/request/map/raster_place.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 11> kMaskMembers{
    "pgm",     "png",        "mode",   "negate", "occupied_thresh", "free_thresh",
    "release", "resolution", "origin", "base",   "multiplier"};

constexpr std::int8_t kLeastOccupied = 65;  // percent
/// How much larger than its cells a part of a mask is, metres. It is more than what decides whether a
/// position is inside, so that the border of two parts is inside.
constexpr double kOverlap = 2e-6;

/// How the percentage of a cell limits the speed: to base + multiplier * percentage, in percent of the
/// robot's own speed. The defaults are from nav2_bringup.
struct SpeedRule {
  double base = 100.0;
  double multiplier = -1.0;

  double limit(int percent) const { return base + multiplier * percent; }
};

constexpr Range kSpeedFactor{-1e6, 1e6, "percent"};
/// The least share of a limit, so that robots arrive in a time that numbers can tell.
constexpr double kLeastShare = 1e-3;

/// As Nav2 has it, a limit of 0 % or beyond 0 to 100 % is none.
bool is_limit(double limit) { return limit > 0.0 && limit <= 100.0; }

/// Where the raster of a mask lies, in the map frame.
struct MaskPlace {
  double resolution = 1.0;
  RasterPose pose;
};

/// A run of cells from the first column to the last one, which is not included.
struct Run {
  int first = 0;
  int last = 0;
  std::int8_t percent = 0;
  bool operator<(const Run& other) const {
    return std::tie(first, last, percent) < std::tie(other.first, other.last, other.percent);
  }
};

/// Returns the runs of one value in a row; runs of 0 are left out.
template <class Value>
std::vector<Run> runs_of_row(int columns, const Value& value) {
  std::vector<Run> runs;
  for (int column = 0; column < columns; ++column) {
    const std::int8_t here = value(column);
    if (here == 0) continue;
    if (runs.empty() || runs.back().last != column || runs.back().percent != here) {
      runs.push_back({column, column, here});
    }
    runs.back().last = column + 1;
  }
  return runs;
}

/// The rectangle of cells of one value.
struct Rectangle {
  std::int8_t percent = 0;
  core::Position low;
  core::Position high;
};

Rectangle rectangle_of(const Run& run, int first_row, int last_row, const MaskPlace& place) {
  const core::Position a = place.pose.turned(place.resolution * core::Position(run.first, first_row));
  const core::Position b = place.pose.turned(place.resolution * core::Position(run.last, last_row));
  const core::Position overlap(kOverlap, kOverlap);
  return {run.percent, place.pose.corner + a.cwiseMin(b) - overlap,
          place.pose.corner + a.cwiseMax(b) + overlap};
}

bool is_on(const Rectangle& rectangle, const core::OccupancyGrid& map) {
  return rectangle.low.x() < map.width() && rectangle.low.y() < map.height() && rectangle.high.x() > 0.0 &&
         rectangle.high.y() > 0.0;
}

/// Joins equal runs of rows above each other. Ends soon after there are more than `max_rectangles` on the
/// map.
template <class Value>
std::vector<Rectangle> rectangles_of(const Raster& raster, const MaskPlace& place,
                                     const core::OccupancyGrid& map, std::size_t max_rectangles,
                                     core::Work& work, const Value& value) {
  std::vector<Rectangle> found;
  std::map<Run, int> open;  // open runs, with the rows where they begin
  for (int row = 0; row <= raster.rows && found.size() <= max_rectangles; ++row) {
    if (work.met_after(static_cast<std::size_t>(raster.columns))) break;
    std::map<Run, int> next;
    if (row < raster.rows) {
      for (const Run& run :
           runs_of_row(raster.columns, [&](int column) { return value(raster.at(column, row)); })) {
        const auto begun = open.find(run);
        next.emplace(run, begun == open.end() ? row : begun->second);
        if (begun != open.end()) open.erase(begun);
      }
    }
    for (const auto& [run, first_row] : open) {
      const Rectangle rectangle = rectangle_of(run, first_row, row, place);
      if (is_on(rectangle, map)) found.push_back(rectangle);
    }
    open = std::move(next);
  }
  return found;
}

/// The value of a percentage, by which cells are joined. 0 for cells that are left out.
std::int8_t value_of(std::int8_t percent, MaskKind kind, const SpeedRule& rule) {
  if (kind == MaskKind::blocked) return percent >= kLeastOccupied ? kFullOccupancy : std::int8_t{0};
  return percent > 0 && is_limit(rule.limit(percent)) ? percent : std::int8_t{0};
}

Meanings meanings_of(MaskKind kind, const SpeedRule& rule) {
  Meanings meanings{};
  for (std::size_t index = 0; index < meanings.size(); ++index) {
    const auto percent = static_cast<std::int8_t>(static_cast<int>(index) + kUnknownOccupancy);
    meanings[index] = value_of(percent, kind, rule);
  }
  return meanings;
}

SpeedRule parse_speed_rule(const JsonReader& mask, MaskKind kind) {
  SpeedRule rule;
  for (const auto& [key, number] :
       {std::pair{"base", &SpeedRule::base}, std::pair{"multiplier", &SpeedRule::multiplier}}) {
    const JsonReader member = mask.find(key);
    if (member && kind == MaskKind::blocked) {
      member.fault(fault::kUnknownKey, std::string(key) +
                                           " is for masks of zones of the type speed only; "
                                           "leave it out, or change the type.");
    }
    rule.*number = member.number(kSpeedFactor).value_or(rule.*number);
  }
  return rule;
}

/// Reads where the mask lies. What it does not say is as of the map.
MaskPlace parse_place(const JsonReader& mask, const WorldMap& map) {
  const double resolution = mask.find("resolution").number(kLength).value_or(map.grid.resolution());
  RasterPose pose = parse_yaml_origin(mask.find("origin")).value_or(map.pose);
  pose.corner = map.frame.to_map(pose.corner);
  return {resolution, pose};
}

/// Reports a mask without a frame of its own that has not one pixel for each cell of the map.
void check_size(const JsonReader& member, const Raster& raster, const WorldMap& map) {
  const bool is_across = map.pose.quarter_turns % 2 == 1;
  const int columns = is_across ? map.grid.rows() : map.grid.columns();
  const int rows = is_across ? map.grid.columns() : map.grid.rows();
  if (raster.columns == columns && raster.rows == rows) return;
  member.fault(fault::kWrongSize,
               "The mask has " + std::to_string(raster.columns) + " x " + std::to_string(raster.rows) +
                   " pixels, but the map has " + std::to_string(columns) + " x " + std::to_string(rows) +
                   " cells; give the resolution and the origin of the mask, as its map.yaml has them.");
}

/// Notes the values of a mask of speeds that are no limits. Also notes values whose limit was different
/// before there were base and multiplier.
void note_speeds(const JsonReader& mask, const Raster& raster, const SpeedRule& rule, const std::string& zone,
                 MaskNotes& notes) {
  std::array<bool, kFullOccupancy + 1> there{};
  for (const std::int8_t percent : raster.occupancy) {
    if (percent > 0) there[static_cast<std::uint8_t>(percent)] = true;
  }
  const bool is_given = mask.find("base") || mask.find("multiplier");
  bool changed = false;
  for (int percent = kFullOccupancy; percent > 0; --percent) {
    if (!there[static_cast<std::size_t>(percent)]) continue;
    const double limit = rule.limit(percent);
    if (!is_limit(limit)) notes.add_without_limit(zone, percent, limit);
    changed = changed || limit != percent;
  }
  if (changed && !is_given) notes.add_changed_speeds(zone);
}

}  // namespace

void MaskNotes::Kind::add(std::string warning) {
  if (masks++ == 0) first = std::move(warning);
}

void MaskNotes::add_changed_pixels(const std::string& zone, std::size_t pixels) {
  pixels_.add(changed_pixels_warning("the mask of zone " + in_quotes(zone), pixels));
}

void MaskNotes::add_changed_speeds(const std::string& zone) {
  speeds_.add(
      "The mask of zone " + in_quotes(zone) +
      " limits the speed to 100 - p percent where it has p percent, as Nav2 does with its base 100 and "
      "multiplier -1; before, it was p percent. Give base 0 and multiplier 1 for the old reading, or "
      "100 and -1 to confirm the new one.");
}

void MaskNotes::add_without_limit(const std::string& zone, int percent, double limit) {
  without_limit_.add("The mask of zone " + in_quotes(zone) + " does not limit the speed where it has " +
                     std::to_string(percent) + " percent: base and multiplier make a limit of " +
                     number_text(limit) +
                     " percent of it, and as in Nav2, 0 and what is not from 0 to 100 is "
                     "none. Use a zone of the type blocked to keep robots out.");
}

void MaskNotes::tell(std::vector<std::string>& warnings) const {
  for (const Kind* kind : {&pixels_, &speeds_, &without_limit_}) {
    if (kind->masks == 0) continue;
    warnings.push_back(kind->first);
    if (kind->masks > 1) warnings.back() += " (And " + std::to_string(kind->masks - 1) + " more like it.)";
  }
}

std::vector<MaskPart> parse_mask(const JsonReader& member, const WorldMap& map, MaskKind kind,
                                 const Limits& limits, Quota& corners, const std::string& zone,
                                 MaskNotes& notes) {
  const std::size_t faults = member.fault_count();
  const JsonReader mask = member.object(kMaskMembers);
  if (!mask) return {};
  const SpeedRule rule = parse_speed_rule(mask, kind);
  const MaskPlace place = parse_place(mask, map);
  const auto read = decode_image(mask, limits.max_cells, meanings_of(kind, rule));
  if (!read) return {};
  const Raster& raster = read->raster;
  if (mask.find("resolution") || mask.find("origin")) {
    check_extent(mask, raster.columns, raster.rows, place.resolution);
  } else {
    check_size(member, raster, map);
  }
  if (member.fault_count() != faults) return {};
  if (read->changed > 0) notes.add_changed_pixels(zone, read->changed);
  if (kind == MaskKind::speed) note_speeds(mask, raster, rule, zone, notes);
  constexpr std::size_t kCorners = 4;
  const auto rectangles = rectangles_of(raster, place, map.grid, corners.left() / kCorners, member.work(),
                                        [&](std::int8_t percent) { return value_of(percent, kind, rule); });
  if (!corners.take(kCorners * rectangles.size(), member)) return {};
  std::vector<MaskPart> parts;
  parts.reserve(rectangles.size());
  for (const Rectangle& one : rectangles) {
    const double share = std::max(rule.limit(one.percent) / 100.0, kLeastShare);
    parts.push_back({share, {one.low, {one.high.x(), one.low.y()}, one.high, {one.low.x(), one.high.y()}}});
  }
  return parts;
}

}  // namespace fleetplan::api
