#include <fleetplan/limits.h>
#include <fleetplan/map.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace fleetplan {

namespace {

constexpr std::int64_t kMaxCells = 1'000'000'000;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("map: " + what); }

bool is_coordinate(double x) { return std::abs(x) <= kFarthestCoordinate; }

}  // namespace

Map::Map(int columns, int rows, double resolution, Position origin)
    : columns_(columns), rows_(rows), resolution_(resolution), origin_(origin) {
  if (columns < 1 || rows < 1) refuse("a map has at least one column and one row");
  if (!(resolution >= kShortestLength)) refuse("the resolution is below the smallest one, 0.0001 m");
  if (!(std::max(columns, rows) * resolution <= kLargestExtent)) refuse("it is larger than 1e6 m");
  if (!is_coordinate(origin.x) || !is_coordinate(origin.y)) refuse("the origin is farther than 1e9 m");
  if (static_cast<std::int64_t>(columns) * rows > kMaxCells) refuse("it has more than 1e9 cells");
  cells_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
}

Map Map::from_rows(std::span<const std::string_view> rows, double resolution, Position origin) {
  constexpr std::size_t kMax = 1'000'000'000;
  if (rows.empty() || rows.size() > kMax || rows[0].size() > kMax)
    refuse("a map has 1 to 1e9 rows and columns");
  const auto columns = static_cast<int>(rows[0].size());
  const auto height = static_cast<int>(rows.size());
  Map map(columns, height, resolution, origin);
  for (std::size_t line = 0; line < rows.size(); ++line) {
    const std::string place = "row " + std::to_string(line) + " (from 0, the top one)";
    if (rows[line].size() != rows[0].size()) refuse(place + " is not as long as the first one");
    for (std::size_t column = 0; column < rows[line].size(); ++column) {
      const char letter = rows[line][column];
      const bool blocked = std::string_view("#@OTW").find(letter) != std::string_view::npos;
      if (!blocked && letter != '.' && letter != 'G') {
        refuse(place + " has another letter than . G # @ O T W");
      }
      map.cells_[map.index(static_cast<int>(column), height - 1 - static_cast<int>(line))] = blocked ? 1 : 0;
    }
  }
  return map;
}

Map Map::from_cells(std::span<const std::uint8_t> cells, int columns, int rows, double resolution,
                    Position origin) {
  Map map(columns, rows, resolution, origin);
  if (cells.size() != map.cells_.size()) refuse("there are not as many cells as columns times rows");
  std::transform(cells.begin(), cells.end(), map.cells_.begin(),
                 [](std::uint8_t cell) { return static_cast<std::uint8_t>(cell != 0 ? 1 : 0); });
  return map;
}

void Map::block(int column, int row, bool blocked) {
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) {
    throw std::out_of_range("map: the cell is outside");
  }
  cells_[index(column, row)] = blocked ? 1 : 0;
}

}  // namespace fleetplan
