#pragma once

// Maps drawn with characters.

#include <stdexcept>
#include <string>
#include <vector>

#include "core/map/occupancy_grid.h"

namespace fleetplan::support {

/// The map that the rows draw, the first row on top: '.' is free, '#' is blocked. Throws
/// std::invalid_argument on an empty map, rows of different lengths, or any other character.
inline core::OccupancyGrid ascii_map(const std::vector<std::string>& rows, double resolution = 1.0) {
  if (rows.empty() || rows.front().empty()) throw std::invalid_argument("an ASCII map needs a cell");
  const int columns = static_cast<int>(rows.front().size());
  const int height = static_cast<int>(rows.size());
  core::OccupancyGrid grid(columns, height, resolution);
  for (int line = 0; line < height; ++line) {
    const std::string& row = rows[static_cast<std::size_t>(line)];
    if (row.size() != rows.front().size()) throw std::invalid_argument("ASCII map rows differ in length");
    for (int column = 0; column < columns; ++column) {
      const char cell = row[static_cast<std::size_t>(column)];
      if (cell != '.' && cell != '#') throw std::invalid_argument("an ASCII map is drawn with . and #");
      if (cell == '#') grid.block({column, height - 1 - line});
    }
  }
  return grid;
}

}  // namespace fleetplan::support
