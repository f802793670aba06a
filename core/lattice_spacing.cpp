#include "core/lattice_spacing.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/interval.h"

namespace fleetplan::core {
namespace {

/// Cells are fine if the smallest radius is at least so many of them.
constexpr double kFineCells = 4.0 * (1.0 - 1e-9);
/// In units of the smallest radius; see docs/method.md.
constexpr double kLargestSpacing = 1.0;

}  // namespace

double lattice_spacing(const Problem& problem, const PlanOptions& options) {
  if (options.lattice_spacing) return *options.lattice_spacing;
  const double resolution = problem.grid().resolution();
  double smallest = kForever;
  // Bounded: each goal once.
  for (const Robot& robot : problem.robots()) {
    smallest = std::min(smallest, robot.radius);
    for (std::size_t k = 0; k < robot.goal_count(); ++k) {
      smallest = std::min(smallest, robot.goal_at(k).radius_after.value_or(smallest));
    }
  }
  if (smallest == kForever || smallest < kFineCells * resolution) return resolution;
  const double shorter_side = std::min(problem.grid().width(), problem.grid().height());
  const double cells = std::min(kLargestSpacing * smallest, shorter_side) / resolution * (1.0 + 1e-9);
  return (2.0 * std::floor(0.5 * (cells - 1.0)) + 1.0) * resolution;
}

}  // namespace fleetplan::core
