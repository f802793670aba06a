#pragma once

// The plan that iterations begin with, and the best one.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/instance/instance.h"
#include "core/model/trajectory.h"
#include "core/prioritized/plan_state.h"

namespace fleetplan::core {

/// The plan that iterations begin with: a trajectory for each planned robot. See BestPlan for the best
/// one.
class Incumbent {
 public:
  /// The trajectories in `state`, whose instance outlives this object; only those of the robots of `planned`
  /// may be replaced.
  Incumbent(const PlanState& state, std::vector<std::size_t> planned);

  /// The number of robots, with and without a trajectory.
  std::size_t robot_count() const { return trajectories_.size(); }
  const std::vector<std::size_t>& planned() const { return planned_; }
  /// All robots with a trajectory, ascending.
  const std::vector<std::size_t>& followers() const { return followers_; }
  const Trajectory& trajectory(std::size_t robot) const { return trajectories_[robot]; }
  double cost(std::size_t robot) const { return trajectories_[robot].cost; }
  /// The robot's share in the objective, and a lower bound of it for all trajectories that cost this much.
  double share(std::size_t robot) const { return shares_[robot]; }
  double least_share(std::size_t robot, double cost) const;
  /// The cost from which on no trajectory of the robot has a share below `share`, seconds.
  double cost_with_share(std::size_t robot, double share) const;
  /// The robot of the highest cost; there is at least one.
  std::size_t last_to_arrive() const;
  double makespan() const { return cost(last_to_arrive()); }
  /// Grows with each replacement, 0 at first.
  std::int64_t version() const { return version_; }
  /// The version of the plan since which it has the robot's trajectory.
  std::int64_t version(std::size_t robot) const { return versions_[robot]; }
  void replace(std::size_t robot, Trajectory trajectory);

 private:
  double share_of(std::size_t robot) const;

  const Instance& instance_;
  std::vector<std::size_t> planned_;
  std::vector<std::size_t> followers_;
  std::vector<Trajectory> trajectories_;  // by robot
  std::vector<double> shares_;            // by robot
  std::int64_t version_ = 0;
  std::vector<std::int64_t> versions_;  // by robot
};

/// The best plan of a search whose incumbent may become worse for a while. Keeps the trajectories in which
/// the two differ.
class BestPlan {
 public:
  /// The incumbent outlives this object, and only this object changes it.
  explicit BestPlan(Incumbent& incumbent) : incumbent_(incumbent) {}

  void replace(std::size_t robot, Trajectory trajectory);
  /// Records a change; call it after its replacements. `gain` is by how much the objective fell, seconds;
  /// negative if it rose. Returns whether the incumbent is better than any plan before.
  bool changed(double gain);

  /// The trajectories of the best plan, by robot, where the incumbent may have others.
  const std::map<std::size_t, Trajectory>& differences() const { return differences_; }
  /// Makes the best plan the incumbent.
  void restore();

 private:
  Incumbent& incumbent_;
  std::map<std::size_t, Trajectory> differences_;
  double loss_ = 0.0;  // seconds by which the incumbent is worse than the best plan
};

}  // namespace fleetplan::core
