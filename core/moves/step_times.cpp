#include "core/moves/step_times.h"

#include <algorithm>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/elementary_functions.h"
#include "core/geometry/tolerance.h"
#include "core/model/served.h"
#include "core/sipp/moves.h"

namespace fleetplan::core {
namespace {

/// What a robot has done in its steps so far.
struct Progress {
  Trajectory trajectory;
  double heading = 0.0;            // radians
  double t_arrive = 0.0;           // seconds; then it has rested where it is
  double t_ready = 0.0;            // seconds; then it has been served there, and may leave
  bool is_served = false;          // where it is: it stops there, even for no time
  SafeInterval safe;               // in which it rests
  std::vector<SizedSegment> past;  // its rests and moves so far, from the begin of its plan on
};

class StepTimes {
 public:
  StepTimes(const FleetReservations& reservations, const std::vector<std::size_t>& robots,
            const JointSteps& steps, double earliest)
      : instance_(reservations.instance()),
        table_(reservations.table()),
        robots_(robots),
        steps_(steps),
        earliest_(earliest),
        margin_(instance_.options().interval_margin) {}

  /// Returns false if a robot cannot stay where its plan begins.
  bool begin() {
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      const Itinerary& itinerary = instance_.itinerary(robots_[k]);
      Progress& progress = progress_.emplace_back();
      progress.trajectory = itinerary.committed;
      if (progress.trajectory.moves.empty()) progress.trajectory.start = steps_.robot(k).at(0).position;
      progress.heading = itinerary.pose.theta;
      progress.t_arrive = itinerary.t_begin;
      progress.t_ready = itinerary.t_begin;
      const auto safe = safe_intervals(k, 0, 0, itinerary.t_begin);
      const auto now = std::find_if(safe.begin(), safe.end(), [&](const SafeInterval& interval) {
        return interval.contains(itinerary.t_begin);
      });
      if (now == safe.end()) return false;
      progress.safe = *now;
      if (!serve(k, 0, steps_.robot(k).at(0).stage)) return false;
    }
    return true;
  }

  bool step(const Configuration& from, const Configuration& to) {
    const auto order = steps_.order_of_step(from, to);
    if (!order) return false;
    for (const std::size_t k : *order) {
      if (!move(k, from[k], to[k])) return false;
    }
    return true;
  }

  std::optional<std::vector<Trajectory>> finish() {
    std::vector<Trajectory> trajectories;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (!end(k)) return std::nullopt;
      trajectories.push_back(std::move(progress_[k].trajectory));
    }
    return trajectories;
  }

 private:
  const View& view(std::size_t k, std::uint32_t stage) const { return instance_.views(robots_[k])[stage]; }
  Footprint footprint(std::size_t k, std::uint32_t stage) const {
    return {robots_[k], view(k, stage).body.radius,
            progress_[k].trajectory.moves.size() > instance_.itinerary(robots_[k]).committed.moves.size()};
  }
  /// When a robot may rest at a place that it comes to from another one, with all loads that it has there.
  std::vector<SafeInterval> safe_intervals(std::size_t k, int from, int place, double t_from) const {
    const StepPlaces& places = steps_.robot(k);
    const StepPlaces::Place& at = places.at(place);
    Footprint widest = footprint(k, at.stage);
    widest.radius = std::max(widest.radius, view(k, places.at(from).stage).body.radius);
    if (place == places.last_goal) widest.radius = std::max(widest.radius, view(k, at.stage + 1).body.radius);
    return table_.safe_intervals(widest, at.position, t_from);
  }

  /// Lets a robot that has arrived be served at the goals from this stage on. Returns false if it cannot rest
  /// for as long.
  bool serve(std::size_t k, std::uint32_t stage, std::uint32_t end) {
    const Itinerary& itinerary = instance_.itinerary(robots_[k]);
    Progress& progress = progress_[k];
    progress.is_served = stage < end;
    for (; stage < end; ++stage) {
      const Goal& goal = itinerary.goals[stage];
      const double heading = goal.theta.value_or(progress.heading);
      const bool has_rested = stage == 0 && progress.trajectory.moves.size() == committed_count(k) &&
                              itinerary.is_committed && is_in_pose(itinerary.pose, goal);
      const double t_rest =
          has_rested ? itinerary.arrived : progress.t_ready + rotation_time(k, stage, goal.position, heading);
      progress.t_ready = std::max(progress.t_ready, goal.service_end(t_rest));
      progress.heading = heading;
      progress.trajectory.visits.push_back({itinerary.first_goal + stage, t_rest, goal.service_end(t_rest)});
    }
    return progress.t_ready <= progress.safe.end;
  }

  double rotation_time(std::size_t k, std::uint32_t stage, const Position& at, double to) const {
    const View& view = this->view(k, stage);
    return MoveTimes(view.body, view.zones.get()).rotation_time(at, progress_[k].heading, to);
  }

  /// The heading of a move: the robot may drive backwards if it turns less then.
  std::pair<double, bool> heading_of_move(std::size_t k, std::uint32_t stage, const Segment& way) const {
    const double ahead = heading_of(way.to - way.from);
    if (!view(k, stage).body.may_reverse) return {ahead, false};
    const double back = opposite_heading(ahead);
    const double now = progress_[k].heading;
    return angle_between(now, back) < angle_between(now, ahead) ? std::pair(back, true)
                                                                : std::pair(ahead, false);
  }

  bool move(std::size_t k, int from, int to) {
    const StepPlaces::Place& here = steps_.robot(k).at(from);
    const StepPlaces::Place& there = steps_.robot(k).at(to);
    const View& view = this->view(k, here.stage);
    const MoveTimes times(view.body, view.zones.get());
    const Segment way{here.position, there.position};
    Progress& progress = progress_[k];
    const auto [heading, reverse] = heading_of_move(k, here.stage, way);
    const bool same_line = angle_between(progress.heading, heading) <= kSameHeading;
    const bool may_go_on = !progress.is_served && same_line && !times.have_parts() &&
                           progress.trajectory.moves.size() > committed_count(k) &&
                           progress.trajectory.moves.back().reverse == reverse;
    const double turned = std::max(progress.t_ready, earliest_) +
                          times.rotation_time(here.position, progress.heading, heading) +
                          view.body.wait_before_move;
    const double duration = times.translation_time(way.length(), [&]() -> const Segment& { return way; });
    const double after_others = free_from(k, times, way, there.radius);
    const double first =
        may_go_on && after_others <= progress.t_arrive ? progress.t_arrive : std::max(turned, after_others);
    for (const SafeInterval& safe : safe_intervals(k, from, to, first)) {
      const double t_min = std::max(first, safe.begin - duration);
      const double t_max = std::min(progress.safe.end, safe.end - duration);
      if (t_min > t_max) continue;
      const auto depart = [&](double t) {
        return earliest_departure(table_, footprint(k, here.stage), times, way, duration, t, t_max);
      };
      auto departure = depart(t_min);
      const bool goes_on = may_go_on && departure && *departure == progress.t_arrive;
      if (departure && !goes_on && *departure < turned) departure = depart(turned);
      if (!departure) continue;
      append(k, way, {*departure, *departure + duration}, times, reverse, goes_on);
      progress.safe = safe;
      progress.heading = heading;
      return serve(k, here.stage, there.stage);
    }
    return false;
  }

  std::size_t committed_count(std::size_t k) const {
    return instance_.itinerary(robots_[k]).committed.moves.size();
  }

  /// The time from which on a move meets none of the others as they have moved so far.
  double free_from(std::size_t k, const MoveTimes& times, const Segment& way, double radius_there) const {
    double t = 0.0;
    const double radius = std::max(times.body().pair_radius, radius_there);
    const std::vector<TimedSegment> parts = parts_of(times.pieces(way));
    const double t_min = progress_[k].t_ready - margin_;
    // Bounded: few robots, and what they did since this one has come.
    for (std::size_t other = 0; other < robots_.size(); ++other) {
      if (other == k) continue;
      const std::vector<SizedSegment>& past = progress_[other].past;
      for (auto segment = past.rbegin(); segment != past.rend() && segment->t_end > t_min; ++segment) {
        const double reach = radius + segment->radius - kSearchSlack;
        t = std::max(t, free_after(MovingDisk(*segment), parts, way.to, reach));
      }
    }
    return t;
  }

  double free_after(const MovingDisk& disk, const std::vector<TimedSegment>& parts, const Position& to,
                    double reach) const {
    double t = 0.0;
    const UnsafeInterval there = unsafe_interval(to, disk, reach);
    if (!there.empty()) t = there.end + margin_ - parts.back().t_end;
    for (const TimedSegment& part : parts) {
      const UnsafeInterval forbidden =
          forbidden_departures(part.path.from, part.velocity(), part.duration(), disk, reach, part.ramp);
      if (!forbidden.empty()) t = std::max(t, forbidden.end + margin_ - part.t_start);
    }
    return t;
  }

  void append(std::size_t k, const Segment& way, const SafeInterval& time, const MoveTimes& times,
              bool reverse, bool goes_on) {
    Progress& progress = progress_[k];
    const double radius = times.body().pair_radius;
    if (time.begin > progress.t_arrive) {
      progress.past.push_back({{{way.from, way.from}, progress.t_arrive, time.begin}, radius});
    }
    for (TimedSegment& part : parts_of(times.pieces(way))) {
      part.t_start += time.begin;
      part.t_end += time.begin;
      progress.past.push_back({part, radius});
    }
    std::vector<TimedMove>& moves = progress.trajectory.moves;
    if (goes_on) {
      moves.back().path.to = way.to;
      moves.back().t_end = time.end;
    } else {
      for (TimedMove& move : timed_moves(times, way, time.begin, time.end, reverse)) moves.push_back(move);
    }
    progress.t_arrive = time.end;
    progress.t_ready = time.end;
  }

  bool end(std::size_t k) {
    const Itinerary& itinerary = instance_.itinerary(robots_[k]);
    Progress& progress = progress_[k];
    if (progress.safe.end != kForever) return false;
    progress.trajectory.cost = progress.t_ready;
    if (!itinerary.yields()) {
      const auto last = static_cast<std::uint32_t>(itinerary.goals.size() - 1);
      if (!serve(k, last, last + 1)) return false;
      progress.trajectory.visits.pop_back();
      progress.trajectory.cost = progress.t_ready;
      if (itinerary.last_goal().radius_after) progress.trajectory.last_served = progress.t_ready;
    }
    return progress.trajectory.cost < instance_.views(robots_[k]).longest_plan();
  }

  const Instance& instance_;
  const ReservationTable& table_;
  const std::vector<std::size_t>& robots_;
  const JointSteps& steps_;
  const double earliest_;  // seconds: nobody sets out before
  const double margin_;    // seconds
  std::vector<Progress> progress_;
};

std::optional<std::vector<Trajectory>> times_from(double earliest, const FleetReservations& reservations,
                                                  const std::vector<std::size_t>& robots,
                                                  const JointSteps& steps,
                                                  const std::vector<Configuration>& configurations,
                                                  const StopCondition& stop) {
  StepTimes times(reservations, robots, steps, earliest);
  if (!times.begin()) return std::nullopt;
  for (std::size_t k = 1; k < configurations.size(); ++k) {
    if (stop.met() || !times.step(configurations[k - 1], configurations[k])) return std::nullopt;
  }
  return times.finish();
}

/// When obstacles, committed motion and all other robots have come to rest, seconds; 0 if nothing else moves.
double rest_of_others(const FleetReservations& reservations, const std::vector<std::size_t>& robots) {
  const Instance& instance = reservations.instance();
  std::vector<bool> moves(instance.size(), false);
  for (const std::size_t robot : robots) moves[robot] = true;
  double t = 0.0;
  for (const MovingObstacle& obstacle : instance.problem().obstacles()) {
    t = std::max(t, obstacle.motion.back().t);
  }
  for (std::size_t robot = 0; robot < instance.size(); ++robot) {
    t = std::max(t, instance.itinerary(robot).t_begin);
    const auto& trajectory = reservations.trajectory(robot);
    if (!moves[robot] && trajectory && !trajectory->moves.empty()) {
      t = std::max(t, trajectory->moves.back().t_end);
    }
  }
  return t;
}

}  // namespace

std::optional<std::vector<Trajectory>> times_of_steps(FleetReservations& reservations,
                                                      const std::vector<std::size_t>& robots,
                                                      const JointSteps& steps,
                                                      const std::vector<Configuration>& configurations,
                                                      const StopCondition& stop) {
  const IgnoredRobots ignored(reservations, robots);
  auto trajectories = times_from(0.0, reservations, robots, steps, configurations, stop);
  if (trajectories) return trajectories;
  const double rest = rest_of_others(reservations, robots);
  if (rest == 0.0) return std::nullopt;
  return times_from(rest, reservations, robots, steps, configurations, stop);
}

}  // namespace fleetplan::core
