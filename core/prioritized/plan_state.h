#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/instance/instance.h"
#include "core/model/trajectory.h"
#include "core/prioritized/enclosure.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/aa_sipp.h"
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

  /// Whether there is none as long as the same robots stay.
  bool none() const { return kind == Kind::not_on_lattice || kind == Kind::closed; }
};

/// The reservations of all robots while a plan is made. The committed motion of every robot is always
/// reserved. After it a robot is in one of four states: it follows a trajectory, stays for ever, reserves its
/// place for some time, or has no reservation (the initial state). Its place is its start, or the end of its
/// committed motion. Plans one robot among the reservations of the others (paper, section Prioritized
/// planning).
class PlanState {
 public:
  explicit PlanState(const Instance& instance);

  const Instance& instance() const { return instance_; }

  /// Each of these replaces the robot's reservation. A trajectory begins with the committed motion.
  void follow(std::size_t robot, Trajectory trajectory);
  void stay_in_place(std::size_t robot);
  /// For so many seconds from the end of the committed motion on.
  void reserve_place(std::size_t robot, double seconds);
  void remove(std::size_t robot);

  /// The reservations of all robots.
  struct Reservations {
    std::vector<std::optional<Trajectory>> trajectories;
    /// Seconds from the end of the committed motion on; kForever for a robot that stays there.
    std::vector<double> holds_place_for;
  };
  const Reservations& reservations() const { return reservations_; }
  /// Replaces all reservations.
  void restore(const Reservations& reservations);
  /// Replaces them, but not in the table of the searches, which takes no time. Only resume() or restore() may
  /// follow.
  void set_without_table(const Reservations& reservations);
  /// Makes searches possible again after set_without_table().
  void resume();

  /// None for a robot that does not follow a trajectory.
  const std::optional<Trajectory>& trajectory(std::size_t robot) const {
    return reservations_.trajectories[robot];
  }

  /// The number of robots that follow a trajectory.
  std::size_t planned_count() const { return planned_count_; }

  /// With a horizon, plan() plans this robot beyond it, to its goals, past all robots that have arrived and
  /// are not planned yet: as long as it has such a way, no later than by its previous plan if possible.
  void plan_whole_way_of(std::size_t robot) { whole_way_of_ = robot; }
  /// None as well if it has no such way.
  const std::optional<std::size_t>& whole_way_of() const { return whole_way_of_; }

  /// Plans a robot that has a goal and no reservation; changes no reservation.
  SearchResult plan(std::size_t robot, const SearchLimits& limits, const StopCondition& stop);
  /// Plans a robot as plan() does, without the reservations of the robots of `ignored`.
  SearchResult plan_ignoring(const std::vector<std::size_t>& ignored, std::size_t robot,
                             const SearchLimits& limits, const StopCondition& stop);

  /// Whether robots yield (Robot::yields).
  bool any_yields() const { return !yielding_.empty(); }
  /// Plans a robot as plan() does, as if each planned robot that yields were gone as soon as it has served
  /// its own goals and stood there for the start safe interval. No trajectory if there are no such robots.
  SearchResult plan_past_yielding(std::size_t robot, const SearchLimits& limits, const StopCondition& stop);
  /// Plans a robot that yields and has a trajectory anew, so that it does not end in the place of a goal of
  /// `other`, which has no reservation: of the goal that is nearest to where it ends now. Changes no
  /// reservation.
  SearchResult plan_leaving_for(std::size_t other, std::size_t robot, const SearchLimits& limits,
                                const StopCondition& stop);
  /// Whether a robot that yields moves after it has served its own goals.
  bool makes_way(std::size_t robot) const;

  /// Whether obstacles allow the robot a move from its start; true if `stop` is met first.
  bool can_leave_place(std::size_t robot, const StopCondition& stop);
  /// Whether the robot has a way to its goal past obstacles and the robots that stay; unknown if `stop` is
  /// met first, or if that takes more than `max_expansions` expansions of a search on the map.
  const Way& way_to_goal(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop);
  /// What is known of that way.
  const Way& way_to_goal(std::size_t robot) const { return ways_[robot]; }
  /// Expansions of searches on the map, for estimates of the cost to the goal.
  std::int64_t map_expansions() const { return map_expansions_; }
  /// Whether the way to the robot's goal, alone on the map, takes longer than any plan may.
  bool takes_too_long(std::size_t robot, const StopCondition& stop);
  /// Estimates its cost, alone on the map, seconds; kForever if `stop` is met first.
  double estimated_alone(std::size_t robot, const StopCondition& stop);
  /// The trajectory of the robot alone on the map; it stays at its start if there is none.
  Trajectory plan_alone(std::size_t robot, const StopCondition& stop);

  /// The robots whose reservations conflict with the trajectory, ascending. Committed motion is left out, of
  /// this robot and of the others: it does not change.
  std::vector<std::size_t> conflicting_robots(std::size_t robot, const Trajectory& trajectory) const;
  /// The robots whose committed motion conflicts with what follows the robot's own commitment, ascending.
  std::vector<std::size_t> robots_committed_against(std::size_t robot, const Trajectory& trajectory) const;
  /// The robots whose reservations conflict with the robot's staying, ascending; committed motion is left
  /// out.
  std::vector<std::size_t> robots_crossing_place(std::size_t robot) const;

  /// Gives up what searches keep for later, if memory is short.
  void relieve_memory();

  /// Expansions of all searches among reservations so far.
  std::int64_t expansions() const { return expansions_; }

 private:
  class EnclosureTest;

  /// Returns the result of a search, or `otherwise` if the memory for it is not granted (see MemoryAccount).
  /// When memory is short, what searches keep for later is given up.
  template <class Result, class Compute>
  Result within_memory(Result otherwise, const Compute& compute);
  void release_memory();
  SearchResult search(std::size_t robot, const SearchLimits& limits, const StopCondition& stop);
  SearchResult search_until(double horizon, std::size_t robot, const SearchLimits& limits,
                            const StopCondition& stop);
  SearchResult search_whole_way(std::size_t robot, const SearchLimits& limits, const StopCondition& stop);
  void find_way(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop);
  std::int64_t find_leg(std::size_t robot, SearchSpace& space, std::size_t goal, std::int64_t max_expansions,
                        const StopCondition& stop);
  bool is_reserved(std::size_t robot, const Reservations& among) const;
  bool stays(std::size_t robot) const { return reservations_.holds_place_for[robot] == kForever; }
  void forget_ways_closed_by_robots(std::size_t except);
  std::vector<std::size_t> arrived_without_plan(std::size_t except) const;
  bool goal_stays_free(std::size_t robot) const;
  std::optional<double> done_from(std::size_t robot) const;
  Way way_off_lattice(std::size_t robot) const;
  bool test_enclosure(std::size_t robot, std::int64_t max_steps);
  void reserve(std::size_t robot, const std::vector<SizedSegment>& segments);
  std::vector<SizedSegment> after_commitment(std::size_t robot, const Trajectory& trajectory) const;
  Trajectory staying(std::size_t robot) const;

  const Instance& instance_;
  ReservationTable table_;
  AaSipp search_;
  Reservations reservations_;
  bool is_in_table_ = true;  // what reservations_ has
  std::size_t planned_count_ = 0;
  SearchSpaces search_spaces_;
  std::size_t staying_count_ = 0;
  std::vector<Way> ways_;                      // by robot
  std::vector<std::size_t> closed_by_robots_;  // robots whose way robots close, until one of those leaves
  std::optional<std::size_t> whole_way_of_;
  std::vector<std::size_t> yielding_;  // ascending
  std::int64_t expansions_ = 0;
  std::int64_t map_expansions_ = 0;
};

}  // namespace fleetplan::core
