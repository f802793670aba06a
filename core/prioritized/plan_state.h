#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/instance.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/aa_sipp.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// Who is where at the moment: every robot holds a trajectory, or stands at its start for ever, or blocks its
/// start for a while, or is not there at all (as at first). Plans one robot among all the others.
class PlanState {
 public:
  explicit PlanState(const Instance& instance);

  const Instance& instance() const { return instance_; }

  /// Each of these replaces what the robot held before.
  void follow(std::size_t robot, Trajectory trajectory);
  void stand_for_ever(std::size_t robot);
  void block_start(std::size_t robot, double seconds);
  void leave(std::size_t robot);

  /// The trajectory that the robot follows, if it does.
  const std::optional<Trajectory>& trajectory(std::size_t robot) const { return trajectories_[robot]; }

  /// How many robots follow a trajectory.
  std::size_t following() const { return following_; }

  /// Plans a robot (with a goal) that has left; changes nobody's reservation.
  SearchResult plan(std::size_t robot, const SearchLimits& limits, const StopCondition& stop);
  /// The same as if the robots of `ignored` were not there.
  SearchResult plan_ignoring(const std::vector<std::size_t>& ignored, std::size_t robot,
                             const SearchLimits& limits, const StopCondition& stop);

  /// May the robot reach its goal on the static map? True when `stop` was met before that was known.
  bool goal_reachable(std::size_t robot, const StopCondition& stop);
  /// The path that the robot would take if it were alone, without regard to time beyond its start.
  Trajectory alone(std::size_t robot, const StopCondition& stop);

  /// The robots in the way of a trajectory, or of standing at the start for ever; ascending.
  std::vector<std::size_t> conflicting_robots(std::size_t robot, const Trajectory& trajectory) const;
  std::vector<std::size_t> robots_conflicting_with_standing(std::size_t robot) const;

  std::int64_t expansions() const { return expansions_; }

 private:
  struct Guide {
    Vertices vertices;
    CostToGo cost_to_go;
    Guide(const Instance& instance, std::size_t robot)
        : vertices(instance, robot), cost_to_go(vertices) {}
  };

  Guide& guide(std::size_t robot);
  void forget_other_guides(std::size_t robot);
  void reserve(std::size_t robot, const std::vector<TimedSegment>& segments);
  Trajectory standing(std::size_t robot) const;

  const Instance& instance_;
  ReservationTable table_;
  AaSipp search_;
  std::vector<std::optional<Trajectory>> trajectories_;
  std::size_t following_ = 0;
  std::vector<std::unique_ptr<Guide>> guides_;
  std::int64_t expansions_ = 0;
};

}  // namespace fleetplan::core
