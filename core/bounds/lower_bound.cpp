#include "core/bounds/lower_bound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

double straight_cost(const Pose& from, const Goal& goal, const Body& body) {
  return straight_cost(GoalLeg{from.position, from.theta, goal}, body);
}

double straight_cost(const GoalLeg& leg, const Body& body) {
  const auto rotation = [&](const std::optional<double>& from, const std::optional<double>& to) {
    return from && to ? body.rotation_time(*from, *to) : 0.0;
  };
  const Position d = leg.to.position - leg.from;
  const double distance = d.norm();
  if (distance <= kSamePosition) return rotation(leg.heading, leg.to.theta);
  const double heading = heading_of(d);
  if (body.may_reverse) return reverse_bound(distance, heading, leg.heading, leg.to.theta, body);
  return rotation(leg.heading, heading) + body.translation_time(distance) + rotation(heading, leg.to.theta);
}

double lower_bound(const GoalLeg& leg, const Body& body) {
  const bool stays = is_same_position(leg.from, leg.to.position);
  return straight_cost(leg, body) + (stays ? 0.0 : body.wait_before_move);
}

std::vector<GoalLeg> legs_of(const Itinerary& itinerary) {
  std::vector<GoalLeg> legs;
  GoalLeg leg{itinerary.pose.position, itinerary.pose.theta, {}};
  for (const Goal& goal : itinerary.goals) {
    leg.to = goal;
    legs.push_back(leg);
    leg = {goal.position, goal.theta, {}};
  }
  // Committed actions that end in contact with the goal's pose end in it.
  const bool in_pose = itinerary.t_begin > 0.0 && !legs.empty() && is_in_pose(itinerary.pose, legs[0].to);
  if (in_pose) legs[0].to = {itinerary.pose.position, itinerary.pose.theta};
  return legs;
}

double end_after(const Itinerary& itinerary, const std::vector<double>& seconds) {
  double t = itinerary.t_begin;
  for (std::size_t k = 0; k < itinerary.goals.size(); ++k) {
    const Goal& goal = itinerary.goals[k];
    const double done = k == 0 ? itinerary.service_done : 0.0;
    t = std::max(t + seconds[k], goal.not_before) + (goal.service - done);
  }
  return t;
}

double lower_bound(const Itinerary& itinerary, const std::vector<Body>& bodies) {
  std::vector<double> seconds;
  for (const GoalLeg& leg : legs_of(itinerary)) {
    seconds.push_back(lower_bound(leg, bodies[seconds.size()]));
  }
  return end_after(itinerary, seconds);
}

namespace {

/// The most, in radians, by which the line of a robot may be beside the direction: beyond that, the robot
/// goes away from the goal.
constexpr double kMaxAside = std::numbers::pi / 2.0;

/// Rotations and length when the robot's line comes within `aside` radians of the direction, at `end`.
class Turns {
 public:
  /// `from`, `to`: how far the headings are from that end of the line, or 0 if they are free.
  Turns(double from, double to, double least_turn, double straight_seconds, double angular_speed)
      : from_(from), to_(to), least_(least_turn), straight_(straight_seconds), speed_(angular_speed) {}

  /// The least cost. It is convex in `aside`. At the minimum, the slope changes its sign: where a rotation
  /// ends, or where the gain of a rotation equals the longer way.
  double least_cost() const {
    const double sum = from_ + to_ - least_;
    double least = std::numeric_limits<double>::infinity();
    for (const double aside :
         {0.0, from_, to_, from_ - least_, to_ - least_, 0.5 * sum, stationary(1.0), stationary(2.0)}) {
      least = std::min(least, cost(std::clamp(aside, 0.0, kMaxAside)));
    }
    return least;
  }

 private:
  double cost(double aside) const {
    const double turn = std::max(from_ - aside, 0.0) + std::max(to_ - aside, 0.0);
    return std::max(turn, least_) / speed_ + straight_ / cosine(aside);
  }

  /// Where a radian less of so many rotations saves as much time as the longer way costs.
  double stationary(double rotations) const {
    const double gain = rotations / (speed_ * straight_);
    const double sine = 2.0 * gain / (1.0 + std::sqrt(1.0 + 4.0 * gain * gain));
    return arctangent(sine, std::sqrt((1.0 - sine) * (1.0 + sine)));
  }

  double from_;
  double to_;
  double least_;
  double straight_;
  double speed_;
};

}  // namespace

double reverse_bound(double distance, double direction, std::optional<double> from_heading,
                     std::optional<double> to_heading, const Body& body) {
  // A longer way loses no less by inertia.
  const double straight = body.cruise_time(distance);
  const double loss = body.linear_inertia.loss(distance, body.linear_speed);
  const double least_turn = from_heading && to_heading ? angle_between(*from_heading, *to_heading) : 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const double end : {direction, opposite_heading(direction)}) {
    const double from = from_heading ? angle_between(*from_heading, end) : 0.0;
    const double to = to_heading ? angle_between(*to_heading, end) : 0.0;
    least = std::min(least, Turns(from, to, least_turn, straight, body.angular_speed).least_cost());
  }
  return least + loss;
}

}  // namespace fleetplan::core
