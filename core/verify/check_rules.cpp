#include "core/verify/check_rules.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// The rounding of a coordinate or a time, relative: the planner and the checker add up many of them.
constexpr double kRounding = 16.0 * kEpsilon;
/// The rounding of a position at a time, relative: both ends of a move are rounded, for each of two robots.
constexpr double kMotionRounding = 2.0 * kEpsilon;
/// How far a start or goal may be from the vertex that stands for it: metres, seconds, radians.
constexpr double kLeast = 2.0 * kSamePosition;

/// Whether actions of the request may be part of the plan. They went through decimal text and world
/// coordinates.
/// The greatest linear speed with any of its loads, metres per second.
double greatest_speed(const Robot& robot) {
  double greatest = robot.linear_speed;
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    greatest = std::max(greatest, robot.goal_at(k).linear_speed_after.value_or(greatest));
  }
  return greatest;
}

bool has_given_actions(const Robot& robot) { return !robot.committed.empty() || robot.previous.has_value(); }

}  // namespace

std::vector<Tolerance> plan_tolerances(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                       const std::vector<RobotPlan>& plans) {
  const double extent = std::max(grid.width(), grid.height());
  const double at_rest = kContactTolerance + kLeast + kRounding * extent;
  std::vector<Tolerance> all(robots.size(), {std::min(kMaxTolerance, at_rest), kLeast, kLeast});
  for (const RobotPlan& plan : plans) {
    if (has_given_actions(robots[plan.robot])) continue;
    Tolerance& tolerance = all[plan.robot];
    const double travel = plan.cost * greatest_speed(robots[plan.robot]);
    tolerance.metres = std::min(kMaxTolerance, at_rest + kMotionRounding * travel);
    tolerance.seconds = kLeast + kRounding * plan.cost;
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (has_given_actions(robots[i])) all[i] = Tolerance::of_all(kMaxTolerance);
  }
  return all;
}

void ViolationList::add(Violation violation) {
  ++total_;
  keep(std::move(violation));
}

void ViolationList::add(ViolationList more) {
  total_ += more.total_;
  for (Violation& violation : more.kept_) keep(std::move(violation));
}

std::vector<Violation> ViolationList::take() {
  sort_and_cut();
  total_ = 0;
  was_cut_ = false;
  return std::exchange(kept_, {});
}

namespace {

bool is_before(const Violation& a, const Violation& b) {
  return std::tie(a.t, a.kind, a.robots, a.obstacle) < std::tie(b.t, b.kind, b.robots, b.obstacle);
}

}  // namespace

void ViolationList::keep(Violation violation) {
  // Mostly they come by time, so that millions cost no more than these.
  if (was_cut_ && !is_before(violation, kept_[kMaxViolations - 1])) return;
  kept_.push_back(std::move(violation));
  if (kept_.size() >= 2 * kMaxViolations) sort_and_cut();
}

void ViolationList::sort_and_cut() {
  std::stable_sort(kept_.begin(), kept_.end(), is_before);
  if (kept_.size() > kMaxViolations) {
    was_cut_ = true;
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(kMaxViolations), kept_.end());
  }
}

}  // namespace fleetplan::core
