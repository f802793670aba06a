#include "core/moves/step_times.h"

#include <algorithm>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/moves/step_moves.h"

namespace fleetplan::core {
namespace {

/// What a robot has done in its steps so far.
struct Progress {
  Trajectory trajectory;
  StepRest rest;
  std::vector<SizedSegment> past;  // its rests and moves so far, from the begin of its plan on
};

class StepTimes {
 public:
  /// Nobody sets out before `earliest` (seconds).
  StepTimes(const FleetReservations& reservations, const std::vector<std::size_t>& robots,
            const JointSteps& steps, double earliest)
      : instance_(reservations.instance()),
        moves_(reservations, robots, steps),
        robots_(robots),
        steps_(steps),
        earliest_(earliest),
        margin_(instance_.options().interval_margin) {}

  /// Returns false if a robot cannot stay where its plan begins.
  bool begin() {
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      Progress& progress = progress_.emplace_back();
      progress.trajectory = moves_.itinerary(k).committed;
      if (progress.trajectory.moves.empty()) progress.trajectory.start = steps_.robot(k).at(0).position;
      const auto rest = moves_.begin(k, &progress.trajectory.visits);
      if (!rest) return false;
      progress.rest = *rest;
    }
    return true;
  }

  /// Nobody departs before `departure` (seconds).
  bool step(const Configuration& from, const Configuration& to, double departure) {
    const auto order = steps_.order_of_step(from, to);
    if (!order) return false;
    for (const std::size_t k : *order) {
      if (!move(k, from[k], to[k], departure)) return false;
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
  bool move(std::size_t k, int from, int to, double departure) {
    const StepPlaces::Place& here = steps_.robot(k).at(from);
    const StepPlaces::Place& there = steps_.robot(k).at(to);
    const MoveTimes times = moves_.times(k, here.stage);
    const Segment way = moves_.way(k, from, to);
    Progress& progress = progress_[k];
    const double after_others = std::max(departure, free_from(k, times, way, there.radius));
    bool has_moved = false;
    moves_.for_each_move(k, from, to, progress.rest, earliest_, after_others, kForever,
                         [&](const TimedStep& step) {
                           append(k, way, step, times);
                           has_moved = true;
                           return true;
                         });
    return has_moved && moves_.serve(k, here.stage, there.stage, progress.rest, &progress.trajectory.visits);
  }

  /// The time from which on a move meets none of the others as they have moved so far.
  double free_from(std::size_t k, const MoveTimes& times, const Segment& way, double radius_there) const {
    double t = 0.0;
    const double radius = std::max(times.body().pair_radius, radius_there);
    const std::vector<TimedSegment> parts = parts_of(times.pieces(way));
    const double t_min = progress_[k].rest.t_ready - margin_;
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

  void append(std::size_t k, const Segment& way, const TimedStep& step, const MoveTimes& times) {
    Progress& progress = progress_[k];
    const double radius = times.body().pair_radius;
    if (step.time.begin > progress.rest.t_arrive) {
      progress.past.push_back({{{way.from, way.from}, progress.rest.t_arrive, step.time.begin}, radius});
    }
    for (TimedSegment& part : parts_of(times.pieces(way))) {
      part.t_start += step.time.begin;
      part.t_end += step.time.begin;
      progress.past.push_back({part, radius});
    }
    std::vector<TimedMove>& moves = progress.trajectory.moves;
    if (step.goes_on) {
      moves.back().path.to = way.to;
      moves.back().t_end = step.time.end;
    } else {
      for (TimedMove& move : timed_moves(times, way, step.time.begin, step.time.end, step.reverse)) {
        moves.push_back(move);
      }
    }
    progress.rest = step.rest;
  }

  bool end(std::size_t k) {
    const Itinerary& itinerary = moves_.itinerary(k);
    auto& [trajectory, rest, past] = progress_[k];
    if (rest.safe.end != kForever) return false;
    trajectory.cost = rest.t_ready;
    if (!itinerary.yields()) {
      const auto last = static_cast<std::uint32_t>(itinerary.goals.size() - 1);
      if (!moves_.serve(k, last, last + 1, rest, &trajectory.visits)) return false;
      trajectory.visits.pop_back();
      trajectory.cost = rest.t_ready;
      if (itinerary.last_goal().radius_after) trajectory.last_served = rest.t_ready;
    }
    return trajectory.cost < instance_.views(robots_[k]).longest_plan();
  }

  const Instance& instance_;
  const StepMoves moves_;
  const std::vector<std::size_t>& robots_;
  const JointSteps& steps_;
  const double earliest_;  // seconds
  const double margin_;    // seconds
  std::vector<Progress> progress_;
};

}  // namespace

std::optional<std::vector<Trajectory>> times_of_steps(FleetReservations& reservations,
                                                      const std::vector<std::size_t>& robots,
                                                      const JointSteps& steps, const StepSequence& sequence,
                                                      const StopCondition& stop) {
  const IgnoredRobots ignored(reservations, robots);
  StepTimes times(reservations, robots, steps, sequence.earliest);
  if (!times.begin()) return std::nullopt;
  const std::vector<Configuration>& configurations = sequence.configurations;
  for (std::size_t k = 1; k < configurations.size(); ++k) {
    const double departure = sequence.departures.empty() ? 0.0 : sequence.departures[k - 1];
    if (stop.met() || !times.step(configurations[k - 1], configurations[k], departure)) return std::nullopt;
  }
  return times.finish();
}

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

}  // namespace fleetplan::core
