#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/model/robot.h"

namespace fleetplan::bench {

struct RobotType {
  double radius;         // metres
  double linear_speed;   // metres per second
  double angular_speed;  // radians per second
};

/// Small and fast, middling, large and slow. The paper counts in cells and time units: here a cell is 1 m and
/// a unit 1 s.
inline constexpr std::array<RobotType, 3> kPaperTypes{
    {{0.3, 1.5, std::numbers::pi}, {0.5, 1.0, std::numbers::pi}, {1.0, 0.5, std::numbers::pi}}};

/// How a workload is generated. The defaults are the paper's empty hall (Yakovlev, Andreychuk and Vorobyev,
/// ECMR 2019, Simulated experiments); its other hall has ten rectangles.
struct Recipe {
  std::string name = "empty";
  int side = 64;       // cells of 1 m; at least kRectangleLength if there are rectangles
  int rectangles = 0;  // obstacles of kRectangleLength x kRectangleWidth cells, which may overlap
  std::size_t robots = 300;
  std::vector<RobotType> types{kPaperTypes.begin(), kPaperTypes.end()};  // in turn
  bool goal_headings = true;                                             // else any heading ends a plan
};

inline constexpr int kRectangleLength = 20;  // cells
inline constexpr int kRectangleWidth = 2;

/// The paper's two halls.
Recipe empty_hall();
Recipe hall_with_rectangles();

/// Disks as wide as a cell that turn almost at once, in an empty hall of 32 x 32 cells, at 1 m/s. These are
/// the crowds of Yakovlev and Andreychuk (AAMAS 2018).
Recipe crowd();

/// The paper's hall "empty" or "rects", or "crowd", with another side (cells) and number of robots, and with
/// as many rectangles per cell. Throws std::runtime_error for another name.
Recipe hall(const std::string& name, int side, std::size_t robots);

/// A map and robots, each with a goal and its heading. An instance of n robots is the first n.
struct Workload {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
};

/// The workload of a seed, the same everywhere. Robots of the recipe's types follow in turn. The cells and
/// headings of starts and goals are uniform at random. Starts do not overlap one another, nor do goals. Both
/// lie in the largest 4-connected set of cells where a disk of the robot's radius fits. If the map is too
/// full for the next robot, the workload ends before it.
Workload generate(const Recipe& recipe, std::uint64_t seed);

/// The largest 4-connected set of cells at whose centre a disk of `radius` metres fits. If several are
/// equally large, the set with the lowest, leftmost cell.
std::vector<core::Cell> largest_room(const core::OccupancyGrid& grid, double radius);

}  // namespace fleetplan::bench
