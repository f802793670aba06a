#include "tests/bench/scaling.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/bench/instance.h"
#include "tests/bench/markdown.h"
#include "tests/bench/summary.h"
#include "tests/bench/workload.h"

namespace fleetplan::bench {
namespace {

constexpr int kPaperSide = 64;          // cells
constexpr std::size_t kFewRobots = 50;  // on every map; the smallest holds them with room to move
constexpr std::size_t kDensity = 60;    // robots to kPaperSide x kPaperSide cells, so 15 to 960

constexpr std::array<std::size_t, 6> kRobots{10, 25, 50, 100, 200, 300};
constexpr std::array<int, 5> kSides{32, 64, 128, 256, 512};
constexpr std::array<int, 4> kDenseSides{32, 64, 128, 256};

/// A hall of another size with as many rectangles to the cell.
Recipe resized(Recipe recipe, int side, std::size_t robots) {
  const double area = static_cast<double>(side) * side / (kPaperSide * kPaperSide);
  recipe.side = side;
  recipe.rectangles = static_cast<int>(std::lround(recipe.rectangles * area));
  recipe.robots = robots;
  return recipe;
}

/// Runs all seeds of a recipe.
Summary run(const Recipe& recipe, const Options& options, const Measure& measure) {
  std::vector<Measurement> runs;
  for (const std::uint64_t seed : options.seeds) {
    const std::string name = recipe.name + "-" + std::to_string(recipe.side) + "/" + std::to_string(seed);
    const Instance instance = make_instance(name, generate(recipe, seed));
    runs.push_back(measure(name, instance.robots(), instance.body(instance.robots(), options.planning)));
  }
  return summarise(runs).back();
}

TableRow row(std::vector<std::string> cells, int side, std::size_t robots, const Options& options,
             const Measure& measure) {
  for (const Recipe& hall : {empty_hall(), hall_with_rectangles()}) {
    const Summary summary = run(resized(hall, side, robots), options, measure);
    cells.push_back(std::to_string(summary.solved) + " of " + std::to_string(summary.runs));
    cells.push_back(seconds_text(summary.median_seconds));
    cells.push_back(decimal(summary.flowtime_by_bound, 3));
    cells.push_back(mebibytes(summary.peak_memory));
  }
  return cells;
}

TableRow head(std::vector<std::string> first) {
  for (const std::string hall : {"empty", "rects"}) {
    for (const std::string column : {" solved", " median s", " / bound", " MiB"})
      first.push_back(hall + column);
  }
  return first;
}

std::string size_text(int side) { return std::to_string(side) + " x " + std::to_string(side); }

}  // namespace

std::string scaling_report(const Options& options, const Measure& measure) {
  std::vector<TableRow> by_robots;
  by_robots.reserve(kRobots.size());
  for (const std::size_t robots : kRobots)
    by_robots.push_back(row({std::to_string(robots)}, kPaperSide, robots, options, measure));
  std::vector<TableRow> by_side;
  by_side.reserve(kSides.size());
  for (const int side : kSides) by_side.push_back(row({size_text(side)}, side, kFewRobots, options, measure));
  std::vector<TableRow> by_dense_side;
  by_dense_side.reserve(kDenseSides.size());
  for (const int side : kDenseSides) {
    const std::size_t robots = kDensity * static_cast<std::size_t>(side * side) / (kPaperSide * kPaperSide);
    by_dense_side.push_back(row({size_text(side), std::to_string(robots)}, side, robots, options, measure));
  }
  return "Robots on " + size_text(kPaperSide) + " cells:\n\n" + markdown_table(head({"robots"}), by_robots) +
         "\n" + std::to_string(kFewRobots) + " robots on maps of other sizes:\n\n" +
         markdown_table(head({"cells"}), by_side) + "\nMaps of other sizes, as many robots to the cell:\n\n" +
         markdown_table(head({"cells", "robots"}), by_dense_side);
}

}  // namespace fleetplan::bench
