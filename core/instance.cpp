#include "core/instance.h"

namespace fleetplan::core {

Instance::Instance(const Problem& problem, const PlanOptions& options)
    : problem_(problem),
      options_(options),
      lattice_(problem.grid(), options.connectivity),
      sight_(problem.grid()) {
  for (const Robot& robot : problem.robots()) {
    motions_.push_back({robot.radius + options.inflation, robot.linear_speed, robot.angular_speed,
                        options.wait_before_move});
    auto& moves = moves_by_radius_[motions_.back().radius];
    if (!moves) moves = std::make_unique<StaticMoves>(lattice_, sight_, motions_.back().radius);
    moves_.push_back(moves.get());
  }
}

}  // namespace fleetplan::core
