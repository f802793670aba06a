#include "api/request/parse_map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/object_reader.h"
#include "api/json/text.h"

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

/// What is wrong with a row of the map, told at the row.
std::optional<Fault> row_fault(const JsonValue& value, const JsonPath& path, std::size_t number,
                               std::size_t columns) {
  const std::string place = "Row " + std::to_string(number) + " of the map";
  const std::string* row = value.string();
  if (row == nullptr) {
    return Fault{path.pointer(), fault::kWrongType,
                 place + " must be a string, not " + described(value) + "."};
  }
  if (row->empty()) {
    return Fault{path.pointer(), fault::kEmpty, place + " is empty; a row has at least one cell."};
  }
  if (const std::size_t bad = row->find_first_not_of(kCells); bad != std::string::npos) {
    return Fault{path.pointer(), fault::kBadMapRow,
                 place + " has " + in_quotes(character_at(*row, bad)) + " in column " + std::to_string(bad) +
                     " (both from 0); free cells are . and G, blocked ones #, @, O, T and W."};
  }
  if (row->size() != columns) {
    return Fault{path.pointer(), fault::kBadMapRow,
                 place + " (from 0) has " + std::to_string(row->size()) + " cells, but row 0 has " +
                     std::to_string(columns) + "; all rows must be of the same length."};
  }
  return std::nullopt;
}

/// The rows, if all of them are good and there are not too many cells.
std::optional<std::vector<std::string_view>> parse_rows(const JsonValue& value, const JsonPath& path,
                                                        std::int64_t max_cells, FaultList& faults) {
  const JsonValue::Array* items = read_array(value, path, faults);
  if (items == nullptr) return std::nullopt;
  if (items->empty()) {
    faults.add(value, path, fault::kEmpty, "rows must hold at least one row of the map.");
    return std::nullopt;
  }
  const std::string* first = items->front().string();
  const std::size_t columns = first != nullptr ? first->size() : 0;
  // A product of two sizes of things in memory does not overflow 64 bits.
  const std::uint64_t cells = static_cast<std::uint64_t>(columns) * items->size();
  if (cells > static_cast<std::uint64_t>(max_cells)) {
    faults.add(value, path, fault::kOutOfRange,
               "The map has " + std::to_string(columns) + " x " + std::to_string(items->size()) + " = " +
                   std::to_string(cells) + " cells; this service takes at most " + std::to_string(max_cells) +
                   ". Use a coarser resolution or a part of the map.");
    return std::nullopt;
  }
  std::vector<std::string_view> rows;
  rows.reserve(items->size());
  for (std::size_t number = 0; number < items->size(); ++number) {
    const JsonValue& item = (*items)[number];
    if (auto found = row_fault(item, path / number, number, columns)) {
      faults.add(item.begins(), std::move(*found));
    } else {
      rows.emplace_back(*item.string());
    }
  }
  if (rows.size() != items->size()) return std::nullopt;
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

WorldFrame parse_origin(const JsonValue& value, const JsonPath& path, FaultList& faults) {
  const ObjectReader reader(value, path, kOriginMembers, faults);
  const auto x = reader.require_number("x", kCoordinate);
  const auto y = reader.require_number("y", kCoordinate);
  return {{x.value_or(0.0), y.value_or(0.0)}};
}

}  // namespace

std::optional<WorldMap> parse_map(const JsonValue& value, const JsonPath& path, std::int64_t max_cells,
                                  FaultList& faults) {
  const std::size_t before = faults.count();
  const ObjectReader reader(value, path, kMembers, faults);
  const double resolution = reader.number_or("resolution", kLength, 1.0);
  WorldFrame frame;
  if (const JsonValue* origin = reader.find("origin")) {
    const JsonPath origin_path = reader.path("origin");
    frame = parse_origin(*origin, origin_path, faults);
  }
  const JsonValue* rows = reader.require("rows", "; give one string for each row, the top one first");
  if (rows == nullptr) return std::nullopt;
  const JsonPath rows_path = reader.path("rows");
  const auto lines = parse_rows(*rows, rows_path, max_cells, faults);
  if (!lines || faults.count() != before) return std::nullopt;
  return WorldMap{draw(*lines, resolution), frame};
}

}  // namespace fleetplan::api
