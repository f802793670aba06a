#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/compile/instance.h"
#include "core/fleet/fleet_reservations.h"
#include "core/fleet/search_memory.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/search_space.h"

namespace fleetplan::core {

/// The way of a robot to its goal among obstacles and robots that stay for ever.
struct Way {
  enum class Kind : std::uint8_t {
    unknown,
    on_lattice,      // the lattice has a path past the obstacles; robots that stay may block it
    not_on_lattice,  // it has none
    closed,          // obstacles and perhaps robots close off the start or the goal, on any lattice
  };
  Kind kind = Kind::unknown;
  std::vector<std::size_t> closed_by;  // see Enclosure::Result; none if obstacles do it alone
  std::optional<double> widest;        // metres; of the way between obstacles that the lattice misses

  /// Whether there is no way as long as the same robots stay.
  bool none() const { return kind == Kind::not_on_lattice || kind == Kind::closed; }
};

/// What is known of the ways of robots past obstacles and robots that stay, whatever the other robots do. It
/// is computed when it is first asked for, and kept.
class StaticWays {
 public:
  /// The arguments must outlive this object. When a robot that stayed leaves, the reservations call
  /// forget_closed_by_robots().
  StaticWays(const FleetReservations& reservations, SearchMemory& memory);

  /// Whether obstacles allow the robot a move from its place; true if `stop` is met first.
  bool can_leave_place(std::size_t robot, const StopCondition& stop);
  /// Whether obstacles allow the robot a move to its last goal, or it begins there. True if `stop` is met
  /// first.
  bool can_enter_last_goal(std::size_t robot, const StopCondition& stop);
  /// Whether the robot has a way to its goal past obstacles and, without a horizon, past the robots that
  /// stay. Unknown if `stop` is met first, or if a search on the map needs more than `max_expansions`
  /// expansions.
  const Way& way_to_goal(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop);
  /// What is known of that way.
  const Way& way_to_goal(std::size_t robot) const { return ways_[robot]; }
  /// Whether obstacles and robots that stay are found to close off the robot. The effort suits a search of so
  /// many expansions. If true, way_to_goal() knows it from now on. False if `stop` is met first.
  bool is_closed_off(std::size_t robot, std::int64_t expansions, const StopCondition& stop);

  /// Whether the way to the robot's goal, alone on the map, takes longer than the longest plan.
  bool takes_too_long(std::size_t robot, const StopCondition& stop);
  /// Estimates the robot's cost alone on the map, seconds. kForever if the cost is 0, or if `stop` is met
  /// first.
  double estimated_alone(std::size_t robot, const StopCondition& stop);
  /// Expansions of searches on the map, for way_to_goal().
  std::int64_t map_expansions() const { return map_expansions_; }

  /// Forgets the ways that robots close. Keeps the way of `left`, a robot that no longer stays: it does not
  /// block itself.
  void forget_closed_by_robots(std::optional<std::size_t> left);
  /// Forgets the way of this robot if robots close it.
  void forget_if_closed_by_robots(std::size_t robot);
  /// Forgets the way of this robot if some of `others` close it.
  void forget_if_closed_by(const std::vector<std::size_t>& others, std::size_t robot);

 private:
  using Robots = std::vector<std::size_t>;

  Robots others_that_stay(std::size_t robot) const;
  bool test_enclosure(std::size_t robot, const Robots& staying, std::int64_t expansions,
                      const StopCondition& stop);
  void find_way(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop);
  std::int64_t find_leg(std::size_t robot, SearchSpace& space, std::size_t goal, std::int64_t max_expansions,
                        const StopCondition& stop);
  Way way_off_lattice(std::size_t robot, const StopCondition& stop) const;

  const FleetReservations& reservations_;
  SearchMemory& memory_;
  const Instance& instance_;
  std::vector<Way> ways_;                      // by robot
  std::vector<std::size_t> closed_by_robots_;  // robots whose way robots close, until any of the closing
                                               // robots leaves
  std::int64_t map_expansions_ = 0;
};

}  // namespace fleetplan::core
