#include "core/moves/step_moves.h"

#include <algorithm>

#include "core/model/served.h"

namespace fleetplan::core {

std::optional<StepRest> StepMoves::begin(std::size_t k, std::vector<Visit>* visits) const {
  const double t_begin = itinerary(k).t_begin;
  const auto safe = safe_intervals(k, 0, 0, false, t_begin);
  const auto now = std::find_if(safe.begin(), safe.end(),
                                [&](const SafeInterval& interval) { return interval.contains(t_begin); });
  if (now == safe.end()) return std::nullopt;
  StepRest rest{itinerary(k).pose.theta, t_begin, t_begin, *now};
  if (!serve(k, 0, steps_.robot(k).at(0).stage, rest, visits)) return std::nullopt;
  return rest;
}

bool StepMoves::serve(std::size_t k, std::uint32_t stage, std::uint32_t end, StepRest& rest,
                      std::vector<Visit>* visits) const {
  const Itinerary& itinerary = this->itinerary(k);
  rest.is_served = stage < end;
  for (; stage < end; ++stage) {
    const Goal& goal = itinerary.goals[stage];
    const double heading = goal.theta.value_or(rest.heading);
    const bool has_rested =
        stage == 0 && !rest.has_left && itinerary.is_committed && is_in_pose(itinerary.pose, goal);
    const double t_rest =
        has_rested ? itinerary.arrived
                   : rest.t_ready + times(k, stage).rotation_time(goal.position, rest.heading, heading);
    rest.t_ready = std::max(rest.t_ready, goal.service_end(t_rest));
    rest.heading = heading;
    if (visits != nullptr)
      visits->push_back({itinerary.first_goal + stage, t_rest, goal.service_end(t_rest)});
  }
  return rest.t_ready <= rest.safe.end;
}

/// When a robot may rest at a place that it comes to from another place, with all its loads there.
std::vector<SafeInterval> StepMoves::safe_intervals(std::size_t k, int from, int place, bool has_left,
                                                    double t_from) const {
  const StepPlaces& places = steps_.robot(k);
  const StepPlaces::Place& at = places.at(place);
  Footprint widest = footprint(k, at.stage, has_left);
  widest.radius = std::max(widest.radius, view(k, places.at(from).stage).body.radius);
  if (place == places.last_goal) widest.radius = std::max(widest.radius, view(k, at.stage + 1).body.radius);
  return table_.safe_intervals(widest, at.position, t_from);
}

/// The heading of a move: the robot may drive backwards if it turns less then.
std::pair<double, bool> StepMoves::heading_of_move(std::size_t k, std::uint32_t stage, const Segment& way,
                                                   double now) const {
  const double ahead = heading_of(way.to - way.from);
  if (!view(k, stage).body.may_reverse) return {ahead, false};
  const double back = opposite_heading(ahead);
  return angle_between(now, back) < angle_between(now, ahead) ? std::pair(back, true)
                                                              : std::pair(ahead, false);
}

}  // namespace fleetplan::core
