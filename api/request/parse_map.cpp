#include "api/request/parse_map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/fault_text.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 3> kMembers{"rows", "resolution", "origin"};
constexpr std::array<std::string_view, 2> kOriginMembers{"x", "y"};
constexpr std::string_view kBlocked = "#@OTW";
constexpr std::string_view kCells = ".G#@OTW";

/// The character of UTF-8 that begins at the offset.
std::string_view character_at(std::string_view text, std::size_t offset) {
  std::size_t end = offset + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return text.substr(offset, end - offset);
}

/// What is wrong with a row of `columns` cells.
std::string row_fault(const JsonReader& item, std::size_t number, std::size_t columns) {
  const std::string place = "Row " + std::to_string(number) + " of the map";
  const auto row = item.string();
  if (!row) return place + " must be a string, not " + item.description() + ".";
  if (row->empty()) return place + " is empty; a row has at least one cell.";
  const std::size_t bad = row->find_first_not_of(kCells);
  if (bad != std::string::npos) {
    return place + " has " + in_quotes(character_at(*row, bad)) + " in column " + std::to_string(bad) +
           " (both from 0); free cells are . and G, blocked ones #, @, O, T and W.";
  }
  return place + " (from 0) has " + std::to_string(row->size()) + " cells, but row 0 has " +
         std::to_string(columns) + "; all rows must be of the same length.";
}

/// The row, if it is one of this many columns.
std::optional<std::string_view> parse_row(const JsonReader& item, std::size_t number, std::size_t columns) {
  const auto row = item.string();
  const bool usable = row && row->size() == columns && !row->empty();
  if (usable && row->find_first_not_of(kCells) == std::string::npos) return row;
  const char* const code = !row ? fault::kWrongType : row->empty() ? fault::kEmpty : fault::kBadMapRow;
  item.fault(code, [&] { return row_fault(item, number, columns); });
  return std::nullopt;
}

/// The rows, if all of them are valid and there are not too many cells.
std::optional<std::vector<std::string_view>> parse_rows(const JsonReader& member, std::int64_t max_cells) {
  const JsonReader items = member.array();
  if (!items) return std::nullopt;
  if (items.size() == 0) {
    items.fault(fault::kEmpty, "rows must contain at least one row of the map.");
    return std::nullopt;
  }
  const std::size_t columns = items.item(0).string().value_or("").size();
  // A product of two sizes of things in memory does not overflow 64 bits.
  const std::uint64_t cells = static_cast<std::uint64_t>(columns) * items.size();
  if (cells > static_cast<std::uint64_t>(max_cells)) {
    items.fault(fault::kOutOfRange, "The map has " + std::to_string(columns) + " x " +
                                        std::to_string(items.size()) + " = " + std::to_string(cells) +
                                        " cells; this service accepts at most " + std::to_string(max_cells) +
                                        ". Use a coarser resolution or a part of the map.");
    return std::nullopt;
  }
  std::vector<std::string_view> rows;
  rows.reserve(items.size());
  std::size_t number = 0;
  for (const JsonReader item : items.items()) {
    if (const auto row = parse_row(item, number++, columns)) rows.push_back(*row);
  }
  if (rows.size() != items.size()) return std::nullopt;
  return rows;
}

core::OccupancyGrid draw(const std::vector<std::string_view>& rows, double resolution) {
  const int columns = static_cast<int>(rows.front().size());
  const int height = static_cast<int>(rows.size());
  core::OccupancyGrid grid(columns, height, resolution);
  for (int line = 0; line < height; ++line) {
    const std::string_view row = rows[static_cast<std::size_t>(line)];
    for (int column = 0; column < columns; ++column) {
      const char cell = row[static_cast<std::size_t>(column)];
      if (kBlocked.find(cell) != std::string_view::npos) grid.block({column, height - 1 - line});
    }
  }
  return grid;
}

/// Reports a map that is larger than the ranges of coordinates and speeds are made for.
void check_extent(const JsonReader& map, const JsonReader& rows, std::size_t columns, std::size_t lines,
                  double resolution) {
  const double width = static_cast<double>(columns) * resolution;
  const double height = static_cast<double>(lines) * resolution;
  if (width <= kLargestExtent && height <= kLargestExtent) return;
  const JsonReader given = map.find("resolution");
  (given ? given : rows)
      .fault(fault::kOutOfRange, "The map is " + number_text(width) + " m x " + number_text(height) +
                                     " m; it must be at most " + number_text(kLargestExtent) +
                                     " m in each direction. Use a smaller resolution or a part of the map.");
}

WorldFrame parse_origin(const JsonReader& member) {
  const JsonReader origin = member.object(kOriginMembers);
  const double x = origin.require("x").number(kCoordinate).value_or(0.0);
  const double y = origin.require("y").number(kCoordinate).value_or(0.0);
  return {{x, y}};
}

}  // namespace

std::optional<WorldMap> parse_map(const JsonReader& member, std::int64_t max_cells) {
  const std::size_t before = member.fault_count();
  const JsonReader map = member.object(kMembers);
  const double resolution = map.find("resolution").number(kLength).value_or(1.0);
  const WorldFrame frame = parse_origin(map.find("origin"));
  const JsonReader rows = map.require("rows", "; give one string for each row, the top one first");
  const auto lines = parse_rows(rows, max_cells);
  if (lines) check_extent(map, rows, lines->front().size(), lines->size(), resolution);
  if (!lines || member.fault_count() != before) return std::nullopt;
  return WorldMap{draw(*lines, resolution), frame};
}

}  // namespace fleetplan::api
