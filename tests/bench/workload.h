#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/model/robot.h"

namespace fleetplan::bench {

/// How a workload is generated. The defaults are the paper's empty hall (Yakovlev, Andreychuk and Vorobyev,
/// ECMR 2019, Simulated experiments); its other hall has ten rectangles.
struct Recipe {
  std::string name = "empty";
  int side = 64;       // cells of 1 m; at least kRectangleLength if there are rectangles
  int rectangles = 0;  // obstacles of kRectangleLength x kRectangleWidth cells, which may overlap
  std::size_t robots = 300;
};

inline constexpr int kRectangleLength = 20;  // cells
inline constexpr int kRectangleWidth = 2;

/// The paper's two halls.
Recipe empty_hall();
Recipe hall_with_rectangles();

/// The paper's hall "empty" or "rects" with another side (cells) and number of robots, and with as many
/// rectangles per cell. Throws std::runtime_error for another name.
Recipe hall(const std::string& name, int side, std::size_t robots);

/// A map and robots, each with a goal and its heading. An instance of n robots is the first n.
struct Workload {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
};

/// The workload of a seed, the same everywhere. Robots of the paper's three types follow in turn; the cells
/// and headings of starts and goals are uniform at random. Starts do not overlap one another, nor do goals;
/// both lie in the largest 4-connected set of cells where a disk of the robot's radius fits. If the map is
/// too full for the next robot, the workload ends before it.
Workload generate(const Recipe& recipe, std::uint64_t seed);

/// The cells of the largest 4-connected set of those at whose centre a disk of `radius` metres fits; of
/// several equally large ones the one with the lowest, leftmost cell.
std::vector<core::Cell> largest_room(const core::OccupancyGrid& grid, double radius);

}  // namespace fleetplan::bench
