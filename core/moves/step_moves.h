#pragma once

// How one robot of a fleet makes a step: when it sets out, rests and is served.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/compile/instance.h"
#include "core/fleet/fleet_reservations.h"
#include "core/geometry/elementary_functions.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/model/trajectory.h"
#include "core/moves/joint_steps.h"
#include "core/sipp/moves.h"

namespace fleetplan::core {

/// A robot that rests at a place between its steps.
struct StepRest {
  double heading = 0.0;    // radians
  double t_arrive = 0.0;   // seconds; then it has rested there
  double t_ready = 0.0;    // seconds; then it has been served there, and may leave
  SafeInterval safe;       // in which it rests
  bool is_served = false;  // there: it stops, even for no time
  bool has_left = false;   // its start
  bool reverse = false;    // it came backwards
};

/// One robot moves to another place.
struct TimedStep {
  SafeInterval time;     // from the departure to the arrival
  bool reverse = false;  // it drives backwards
  bool goes_on = false;  // on the line of its step before, without a stop
  StepRest rest;         // after it
};

/// The moves of the robots that make steps, among the reservations of all other robots.
class StepMoves {
 public:
  /// All arguments must outlive this object. `steps` belong to `robots`, in their order.
  StepMoves(const FleetReservations& reservations, const std::vector<std::size_t>& robots,
            const JointSteps& steps)
      : instance_(reservations.instance()), table_(reservations.table()), robots_(robots), steps_(steps) {}

  const Itinerary& itinerary(std::size_t k) const { return instance_.itinerary(robots_[k]); }
  const View& view(std::size_t k, std::uint32_t stage) const { return instance_.views(robots_[k])[stage]; }
  MoveTimes times(std::size_t k, std::uint32_t stage) const {
    return {view(k, stage).body, view(k, stage).zones.get()};
  }
  Segment way(std::size_t k, int from, int to) const {
    return {steps_.robot(k).at(from).position, steps_.robot(k).at(to).position};
  }

  /// The rest of a robot where its plan begins; none if it cannot stay there. Its visits to goals there are
  /// added to `visits`, which may be null.
  std::optional<StepRest> begin(std::size_t k, std::vector<Visit>* visits) const;

  /// Serves a robot that rests at the goals of these stages. Returns false if it cannot rest there long
  /// enough.
  bool serve(std::size_t k, std::uint32_t stage, std::uint32_t end, StepRest& rest,
             std::vector<Visit>* visits) const;

  /// Calls visit(TimedStep) for the earliest move into each safe interval of the place that a step leads to,
  /// in their order, until it returns true. `after_others`, `before_others`: seconds; the robot departs no
  /// sooner, and arrives no later. `earliest`: seconds; the robot does not turn sooner.
  template <class Visitor>
  void for_each_move(std::size_t k, int from, int to, const StepRest& rest, double earliest,
                     double after_others, double before_others, const Visitor& visit) const;

 private:
  Footprint footprint(std::size_t k, std::uint32_t stage, bool has_left) const {
    return {robots_[k], view(k, stage).body.radius, has_left};
  }
  std::vector<SafeInterval> safe_intervals(std::size_t k, int from, int place, bool has_left,
                                           double t_from) const;
  std::pair<double, bool> heading_of_move(std::size_t k, std::uint32_t stage, const Segment& way,
                                          double now) const;

  const Instance& instance_;
  const ReservationTable& table_;
  const std::vector<std::size_t>& robots_;
  const JointSteps& steps_;
};

template <class Visitor>
void StepMoves::for_each_move(std::size_t k, int from, int to, const StepRest& rest, double earliest,
                              double after_others, double before_others, const Visitor& visit) const {
  const std::uint32_t stage = steps_.robot(k).at(from).stage;
  const MoveTimes times = this->times(k, stage);
  const Segment way = this->way(k, from, to);
  TimedStep step;
  const auto [heading, reverse] = heading_of_move(k, stage, way, rest.heading);
  const bool may_go_on = !rest.is_served && rest.has_left && rest.reverse == reverse && !times.have_parts() &&
                         angle_between(rest.heading, heading) <= kSameHeading;
  const double turned = std::max(rest.t_ready, earliest) +
                        times.rotation_time(way.from, rest.heading, heading) + times.body().wait_before_move;
  const double duration = times.translation_time(way.length(), [&]() -> const Segment& { return way; });
  const double first =
      may_go_on && after_others <= rest.t_arrive ? rest.t_arrive : std::max(turned, after_others);
  for (const SafeInterval& safe : safe_intervals(k, from, to, rest.has_left, first)) {
    const double t_min = std::max(first, safe.begin - duration);
    const double t_max = std::min(rest.safe.end, std::min(safe.end, before_others) - duration);
    if (t_min > t_max) continue;
    const auto depart = [&](double t) {
      return earliest_departure(table_, footprint(k, stage, rest.has_left), times, way, duration, t, t_max);
    };
    auto departure = depart(t_min);
    step.goes_on = may_go_on && departure && *departure == rest.t_arrive;
    if (departure && !step.goes_on && *departure < turned) departure = depart(turned);
    if (!departure) continue;
    step.time = {*departure, *departure + duration};
    step.reverse = reverse;
    step.rest = {heading, step.time.end, step.time.end, safe, false, true, reverse};
    if (visit(step)) return;
  }
}

}  // namespace fleetplan::core
