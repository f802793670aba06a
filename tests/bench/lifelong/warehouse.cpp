#include "tests/bench/lifelong/warehouse.h"

#include <numbers>

namespace fleetplan::bench {
namespace {

constexpr double kCell = 0.5;       // metres
constexpr double kDistance = 0.05;  // metres from a robot to the shelf that it faces
constexpr int kLeft = 12;           // cells between the west wall and the first shelf
constexpr int kBelow = 4;           // cells between the south wall and the first shelf
constexpr int kShelfLength = 16;
constexpr int kShelfDepth = 2;
constexpr int kAisle = 3;
constexpr int kStationLength = 3;
constexpr int kStationSpacing = 4;

void block(core::OccupancyGrid& grid, core::Cell first, int columns, int rows) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) grid.block({first.column + column, first.row + row});
  }
}

/// The lower left cell of every shelf.
std::vector<core::Cell> shelves(const Warehouse& warehouse) {
  std::vector<core::Cell> cells;
  for (int row = 0; row < warehouse.shelf_rows; ++row) {
    for (int column = 0; column < warehouse.shelf_columns; ++column) {
      cells.push_back({kLeft + column * (kShelfLength + kAisle), kBelow + row * (kShelfDepth + kAisle)});
    }
  }
  return cells;
}

}  // namespace

core::OccupancyGrid warehouse_map(const Warehouse& warehouse) {
  const int columns = kLeft + warehouse.shelf_columns * (kShelfLength + kAisle) + 1;
  const int rows = kBelow + warehouse.shelf_rows * (kShelfDepth + kAisle);
  core::OccupancyGrid grid(columns, rows, kCell);
  for (const core::Cell& shelf : shelves(warehouse)) block(grid, shelf, kShelfLength, kShelfDepth);
  for (int row = kStationSpacing - 1; row < rows - 2; row += kStationSpacing) {
    block(grid, {0, row}, kStationLength, 1);
  }
  return grid;
}

std::vector<core::Pose> shelf_places(const Warehouse& warehouse, double radius) {
  constexpr double kUp = std::numbers::pi / 2.0;
  std::vector<core::Pose> places;
  for (const core::Cell& shelf : shelves(warehouse)) {
    for (int column = 0; column < kShelfLength; ++column) {
      const double x = (shelf.column + column + 0.5) * kCell;
      const double bottom = shelf.row * kCell;
      const double top = (shelf.row + kShelfDepth) * kCell;
      places.push_back({{x, bottom - radius - kDistance}, kUp});
      places.push_back({{x, top + radius + kDistance}, -kUp});
    }
  }
  return places;
}

}  // namespace fleetplan::bench
