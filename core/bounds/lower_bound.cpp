#include "core/bounds/lower_bound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/bounds/reverse_bound.h"
#include "core/geometry/same_position.h"
#include "core/geometry/tolerance.h"
#include "core/model/served_goals.h"

namespace fleetplan::core {

double straight_cost(const Pose& from, const Goal& goal, const Motion& motion) {
  return straight_cost(GoalLeg{from.position, from.theta, goal}, motion);
}

double straight_cost(const GoalLeg& leg, const Motion& motion) {
  const auto rotation = [&](const std::optional<double>& from, const std::optional<double>& to) {
    return from && to ? motion.rotation_time(*from, *to) : 0.0;
  };
  const Position d = leg.to.position - leg.from;
  const double distance = d.norm();
  if (distance <= kSamePosition) return rotation(leg.heading, leg.to.theta);
  const double heading = std::atan2(d.y(), d.x());
  if (motion.may_reverse) return reverse_bound(distance, heading, leg.heading, leg.to.theta, motion);
  return rotation(leg.heading, heading) + motion.translation_time(distance) + rotation(heading, leg.to.theta);
}

double lower_bound(const GoalLeg& leg, const Motion& motion) {
  const bool stays = is_same_position(leg.from, leg.to.position);
  return straight_cost(leg, motion) + (stays ? 0.0 : motion.wait_before_move);
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

double lower_bound(const Robot& robot, const Motion& motion) {
  const Itinerary itinerary = itinerary_of(robot);
  std::vector<double> seconds;
  for (const GoalLeg& leg : legs_of(itinerary)) seconds.push_back(lower_bound(leg, motion));
  return end_after(itinerary, seconds);
}

}  // namespace fleetplan::core
