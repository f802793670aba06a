#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// The times at which pairs may collide, see CheckRules::exempt. Unavoidable collisions count only if they
/// begin while both bodies do what is certain: obstacles move, robots execute their commitments, and robots
/// without a plan or a goal stay for ever where these end. A robot with kMostUnavoidableOfRobot collisions
/// has no more listed, so all that it certainly does is exempt from the last one on.
class Exemptions {
 public:
  /// Finds the times. `obstacles` are the legs of the moving obstacles, `obstacle_radii` their radii. All
  /// robots are enlarged by `inflation` and, against robots, by their vicinity. Incomplete if `stop` is met.
  Exemptions(const std::vector<UnavoidableCollision>& collisions, const ExecutedFleet& fleet,
             double inflation, const std::vector<std::vector<Leg>>& obstacles,
             const std::vector<double>& obstacle_radii, const StopCondition& stop);

  /// The times at which two robots, by their positions in the fleet in any order, may collide.
  const std::vector<TimeSpan>& of_robots(std::size_t one, std::size_t other) const;
  const std::vector<TimeSpan>& with_obstacle(std::size_t robot, std::size_t obstacle) const;

  /// Whether an overlap of this pair that begins at `t` is exempt.
  bool allow_robots(std::size_t one, std::size_t other, double t) const;
  bool allow_obstacle(std::size_t robot, std::size_t obstacle, double t) const;
  /// Whether all overlaps of the robot with obstacles in this time are exempt.
  bool allow_all_obstacles(std::size_t robot, const TimeSpan& time) const {
    return certain_[robot].exempt_from <= time.begin && time.end <= certain_[robot].until;
  }

 private:
  using Spans = std::unordered_map<std::uint64_t, std::vector<TimeSpan>>;

  /// The end of what a robot certainly does, and the time from which on its collisions are exempt.
  struct Certain {
    double until = 0.0;
    double exempt_from = 0.0;
  };
  void count(std::size_t position, double t, std::vector<std::size_t>& collisions);
  bool is_certain(std::size_t position, double t) const;
  void add_pair(std::size_t one, std::size_t other_robot, double t);
  void add_obstacle(std::size_t position, std::size_t obstacle, double t);
  void add_robots(std::size_t one, std::size_t other, double t);

  static const std::vector<TimeSpan>& find(const Spans& spans, std::uint64_t pair);
  std::uint64_t key(std::size_t one, std::size_t other) const;

  const ExecutedFleet& fleet_;
  const double inflation_;
  const std::vector<std::vector<Leg>>& obstacles_;
  const std::vector<double>& obstacle_radii_;
  std::size_t robots_;
  std::vector<Certain> certain_;  // by position
  Spans of_robots_;
  Spans with_obstacles_;
};

/// Whether an overlap that begins at `t` lies in one of the spans.
bool any_contains(const std::vector<TimeSpan>& spans, double t);

}  // namespace fleetplan::core
