#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/geometry/angle.h"
#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"

namespace fleetplan::core {

/// How one robot moves, as the search sees it.
struct Motion {
  double radius = 0.0;  // metres, inflation included
  double linear_speed = 0.0;
  double angular_speed = 0.0;
  double wait_before_move = 0.0;  // seconds

  double translation_time(double distance) const { return distance / linear_speed; }
  /// Seconds to turn from one normalised heading to another, the shorter way.
  double rotation_time(double from, double to) const { return angle_between(from, to) / angular_speed; }
};

/// What stays the same while one request is planned: problem, options, lattice, static feasibility. Not
/// thread-safe, as static moves are computed when first asked for.
class Instance {
 public:
  Instance(const Problem& problem, const PlanOptions& options);

  std::size_t size() const { return problem_.robots().size(); }
  const Problem& problem() const { return problem_; }
  const PlanOptions& options() const { return options_; }
  const Robot& robot(std::size_t index) const { return problem_.robots()[index]; }
  const Motion& motion(std::size_t index) const { return motions_[index]; }
  const Lattice& lattice() const { return lattice_; }
  const LineOfSight& sight() const { return sight_; }
  /// The static moves of robots of this robot's radius.
  StaticMoves& moves(std::size_t index) const { return *moves_[index]; }

 private:
  const Problem& problem_;
  PlanOptions options_;
  Lattice lattice_;
  LineOfSight sight_;
  std::vector<Motion> motions_;
  std::unordered_map<double, std::unique_ptr<StaticMoves>> moves_by_radius_;
  std::vector<StaticMoves*> moves_;  // by robot
};

}  // namespace fleetplan::core
