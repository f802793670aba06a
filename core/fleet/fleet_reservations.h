#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/compile/instance.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"

namespace fleetplan::core {

/// The reservations of all robots while a plan is made, and the conflicts between robots.
///
/// The committed motion of every robot is always reserved. After it, a robot is in one of four states:
///
/// - It follows a trajectory.
/// - It stays in its place for ever.
/// - It holds its place for some time.
/// - It has no reservation (the initial state).
///
/// Its place is its start, or the end of its committed motion.
class FleetReservations {
 public:
  /// Called with the robot that no longer stays for ever; with none if it may be any robot.
  using OnLeave = std::function<void(std::optional<std::size_t> robot)>;

  /// `instance` outlives this object.
  FleetReservations(const Instance& instance, OnLeave on_leave);

  const Instance& instance() const { return instance_; }

  /// Each of these replaces the robot's reservation. A trajectory begins with the committed motion.
  void follow(std::size_t robot, Trajectory trajectory);
  void stay_in_place(std::size_t robot);
  /// Holds the place for so many seconds after the committed motion. kForever: the robot stays.
  void reserve_place(std::size_t robot, double seconds);
  void remove(std::size_t robot);

  /// None for a robot that does not follow a trajectory.
  const std::optional<Trajectory>& trajectory(std::size_t robot) const {
    return reserved_.trajectories[robot];
  }
  /// How long the robot reserves its place after its committed motion, seconds. 0 if it follows a trajectory
  /// or has no reservation; kForever if it stays.
  double holds_place_for(std::size_t robot) const { return reserved_.holds_place_for[robot]; }
  bool stays(std::size_t robot) const { return holds_place_for(robot) == kForever; }
  /// The number of robots that follow a trajectory.
  std::size_t planned_count() const { return planned_count_; }
  bool any_stays() const { return staying_count_ > 0; }
  /// The robots that stay, ascending. Robots that are ignored are left out.
  std::vector<std::size_t> staying_robots() const;

  /// The reservations of all robots, to return to later.
  struct Snapshot {
    std::vector<std::optional<Trajectory>> trajectories;
    std::vector<double> holds_place_for;  // seconds, see holds_place_for()
  };
  Snapshot snapshot() const { return reserved_; }
  /// Replaces all reservations.
  void restore(Snapshot wanted);
  /// Replaces the reservations, but not in the table of the searches, so it takes hardly any time. Until
  /// resume() or restore(), only trajectories and places may be asked for. No search and no question about
  /// conflicts is allowed.
  void set_without_table(Snapshot wanted);
  /// Also puts into the table of the searches what set_without_table() has set.
  void resume();

  /// The robots whose reservations conflict with the trajectory, ascending. Committed motion of this robot
  /// and of the others is left out, because it does not change.
  std::vector<std::size_t> conflicting_robots(std::size_t robot, const Trajectory& trajectory) const;
  /// The robots whose committed motion conflicts with the trajectory after this robot's own commitment,
  /// ascending.
  std::vector<std::size_t> robots_committed_against(std::size_t robot, const Trajectory& trajectory) const;
  /// The robots whose reservations conflict with the robot if it stays, ascending. Committed motion is left
  /// out.
  std::vector<std::size_t> robots_crossing_place(std::size_t robot) const;

  /// The table that searches ask.
  const ReservationTable& table() const { return table_; }

  // For a single search, the table may differ from what the robots do.

  /// Searches, and questions about conflicts, leave out the reservation of an ignored robot.
  void ignore(std::size_t robot, bool ignored) {
    table_.ignore(robot, ignored);
    is_ignored_[robot] = ignored;
  }
  bool is_ignored(std::size_t robot) const { return is_ignored_[robot]; }
  /// Reserves only the part before `t` (seconds) of the trajectory that the robot follows.
  void shorten(std::size_t robot, double t);
  /// Undoes shorten().
  void lengthen(std::size_t robot);
  /// Reserves the place of a goal for ever, for a robot without a reservation. `goal` is its position in
  /// Itinerary::goals. The reservation begins so late that others can leave before. remove() undoes it.
  void reserve_goal(std::size_t robot, std::size_t goal);

 private:
  bool is_reserved(std::size_t robot, const Snapshot& among) const;
  std::vector<SizedSegment> after_commitment(std::size_t robot, const Trajectory& trajectory) const;

  const Instance& instance_;
  const OnLeave on_leave_;
  ReservationTable table_;
  Snapshot reserved_;
  std::vector<bool> is_ignored_;  // by robot
  bool is_in_table_ = true;       // what reserved_ has
  std::size_t planned_count_ = 0;
  std::size_t staying_count_ = 0;
};

/// During its lifetime, searches and questions about conflicts leave out the reservations of some robots.
class IgnoredRobots {
 public:
  IgnoredRobots(FleetReservations& reservations, std::vector<std::size_t> robots)
      : reservations_(reservations), robots_(std::move(robots)) {
    std::erase_if(robots_, [&](std::size_t robot) { return reservations_.is_ignored(robot); });
    for (const std::size_t robot : robots_) reservations_.ignore(robot, true);
  }
  ~IgnoredRobots() {
    for (const std::size_t robot : robots_) reservations_.ignore(robot, false);
  }
  IgnoredRobots(const IgnoredRobots&) = delete;
  IgnoredRobots& operator=(const IgnoredRobots&) = delete;

 private:
  FleetReservations& reservations_;
  std::vector<std::size_t> robots_;  // the robots that were not ignored before
};

/// The largest disk of each robot at any time, by robot.
std::vector<LargestDisk> largest_disks(const Instance& instance);

}  // namespace fleetplan::core
