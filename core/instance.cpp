#include "core/instance.h"

#include <algorithm>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// More than what a disk in contact with an obstacle overlaps it, rounding included.
constexpr double kMostOverlap = kContactTolerance + 2.0 * kSamePosition;

std::vector<Endpoints> endpoints(const Problem& problem, const Lattice& lattice, double inflation) {
  const auto rounding = [&](const Position& p) { return (lattice.snapped(p) - p).norm(); };
  std::vector<Endpoints> all;
  for (const Robot& robot : problem.robots()) {
    Endpoints ends;
    ends.radius = robot.radius + inflation;
    ends.start = robot.start.position;
    ends.start_rounding = rounding(ends.start);
    if (robot.goal) {
      ends.goal = robot.goal->position;
      ends.goal_rounding = rounding(*ends.goal);
    }
    all.push_back(ends);
  }
  return all;
}

}  // namespace

Instance::Instance(const Problem& problem, const PlanOptions& options)
    : problem_(problem),
      options_(options),
      lattice_(problem.grid(), options.connectivity),
      sight_(problem.grid()),
      contacts_(endpoints(problem, lattice_, options.inflation)) {
  for (const Robot& robot : problem.robots()) {
    itineraries_.push_back(itinerary_of(robot));
    motions_.push_back({robot.radius + options.inflation, robot.linear_speed, robot.angular_speed,
                        options.wait_before_move});
    auto& moves = moves_by_radius_[motions_.back().radius];
    if (!moves) moves = std::make_unique<StaticMoves>(lattice_, sight_, motions_.back().radius);
    moves_.push_back(moves.get());
  }
}

double Instance::radius_at_start(std::size_t index) const {
  const Robot& robot = problem_.robots()[index];
  return sight_.fitting_radius(itineraries_[index].pose.position, robot.radius - kMostOverlap,
                               motions_[index].radius);
}

bool Instance::fits_at_start(std::size_t index) const {
  return sight_.disk_fits(itineraries_[index].pose.position, motions_[index].radius);
}

bool Instance::fits_at_goal(std::size_t index) const {
  const std::vector<Goal>& goals = itineraries_[index].goals;
  return std::all_of(goals.begin(), goals.end(), [&](const Goal& goal) {
    return sight_.disk_fits(goal.position, motions_[index].radius - kMostOverlap);
  });
}

double Instance::longest_plan(std::size_t index) const {
  return std::min(kLongestPlan, kLongestTravel / motions_[index].linear_speed);
}

double Instance::radius_at_goal(std::size_t index, const Position& goal) const {
  const double radius = motions_[index].radius;
  return sight_.fitting_radius(goal, radius - kMostOverlap, radius);
}

}  // namespace fleetplan::core
