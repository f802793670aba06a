#include "api/request/map/rows_map.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/faults.h"
#include "api/request/map/cell_letters.h"

namespace fleetplan::api {

namespace {

/// What is wrong with a row of `columns` cells.
std::string row_fault(const JsonReader& item, std::size_t number, std::size_t columns) {
  const std::string place = "Row " + std::to_string(number) + " of the map";
  const auto row = item.string();
  if (!row) return place + " must be a string, not " + item.description() + ".";
  if (row->empty()) return place + " is empty; a row has at least one cell.";
  if (const auto bad = first_other_letter(*row, CellLetters::of_rows)) {
    return place + " has " + in_quotes(character_at(*row, *bad)) + " in column " + std::to_string(*bad) +
           " (both from 0); free cells are . and G, blocked ones #, @, O, T and W.";
  }
  return place + " (from 0) has " + std::to_string(row->size()) + " cells, but row 0 has " +
         std::to_string(columns) + "; all rows must be of the same length.";
}

/// The row, if it is one of this many columns.
std::optional<std::string_view> parse_row(const JsonReader& item, std::size_t number, std::size_t columns) {
  const auto row = item.string();
  const bool usable = row && row->size() == columns && !row->empty();
  if (usable && !first_other_letter(*row, CellLetters::of_rows)) return row;
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
  if (!check_cells(items, columns, items.size(), max_cells)) return std::nullopt;
  std::vector<std::string_view> rows;
  rows.reserve(items.size());
  std::size_t number = 0;
  for (const JsonReader item : items.items()) {
    if (const auto row = parse_row(item, number++, columns)) rows.push_back(*row);
  }
  if (rows.size() != items.size()) return std::nullopt;
  return rows;
}

}  // namespace

std::optional<WorldMap> parse_rows_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const MapFrame frame = parse_map_frame(map);
  const JsonReader member = map.find("rows");
  const auto rows = parse_rows(member, max_cells);
  const JsonReader resolution = map.find("resolution");
  if (rows) {
    const auto columns = static_cast<double>(rows->front().size());
    check_extent(resolution ? resolution : member, columns, static_cast<double>(rows->size()),
                 frame.resolution);
  }
  if (!rows || map.fault_count() != before) return std::nullopt;
  return WorldMap{draw(*rows, frame.resolution, map.stop()), frame.frame};
}

}  // namespace fleetplan::api
