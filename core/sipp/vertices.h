#pragma once

// One robot's view of the static map, while it carries one load.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/lattice.h"
#include "core/model/drive_zones.h"
#include "core/model/motion.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/move_times.h"
#include "core/sipp/own_vertices.h"

namespace fleetplan::core {

class Instance;

/// The vertices that the robot may stop at, and the straight moves between them: those of the lattice, those
/// that refine it for its radius, and its own start and goals where they lie off the lattice. A robot whose
/// load changes has one view for each of its loads.
class Vertices {
 public:
  /// The view with the load of the robot in a stage, see RobotStages.
  /// If `stop` is met first, the view is not finished() and must not be used.
  Vertices(const Instance& instance, std::size_t robot, std::size_t stage, const StopCondition& stop);
  /// The view with one goal and without a start, until replace_start() gives one: for robots that are alike,
  /// one after the other, on their ways to the same goal.
  Vertices(const Instance& instance, std::size_t robot, const Goal& goal);
  /// Makes the place where the plan of this robot begins the start, instead of the one before. What it adds
  /// to the vertices of the goal comes last.
  void replace_start(const Instance& instance, std::size_t robot);

  bool finished() const { return finished_; }

  /// The pose of a goal; without a heading, any will do.
  struct GoalPose {
    int vertex = -1;
    std::optional<double> heading;
    bool operator==(const GoalPose&) const = default;
  };
  /// -1 if the robot has another load there.
  int start() const { return start_; }
  /// The poses of the goals that are left to visit, in their order; empty for a parked robot. Goals at which
  /// the robot neither arrives nor leaves with this load have no vertex.
  const std::vector<GoalPose>& goals() const { return goals_; }

  /// How long moves take.
  const MoveTimes& times() const { return times_; }
  const Motion& motion() const { return times_.motion(); }
  const Lattice& lattice() const { return lattice_; }
  /// Whether the search may leave the lattice's directions.
  bool any_angle() const { return any_angle_; }

  int count() const { return own_.end(); }

  Position position(int vertex) const {
    if (vertex < lattice_.vertex_count()) return lattice_.position(vertex);
    return own_.contains(vertex) ? own_.position(vertex) : finer_.position(vertex);
  }

  /// From one vertex to another.
  Displacement between(int from, int to) const {
    const bool on_lattice = from < lattice_.vertex_count() && to < lattice_.vertex_count();
    return on_lattice ? lattice_.between(from, to) : Displacement::between(position(from), position(to));
  }

  /// Returns whether the straight move does not lead back to a start that is too near to a wall, nor into a
  /// zone that the robot has to leave, and one-way zones allow it.
  bool allow(int from, int to) const {
    if (own_.leads_back(from, to)) return false;
    if (own_.is_inside(from) || own_.is_inside(to)) return from == to || own_.leads_out(from, to);
    return zones_ == nullptr || zones_->allow(position(from), position(to));
  }

  /// Returns whether obstacles leave the straight line between two vertices free for the robot (paper,
  /// "Estimating the feasibility of the move w.r.t. static obstacles"), and the move is allowed.
  bool in_sight(int from, int to) const { return is_free(from, to) && allow(from, to); }

  /// Calls visit(vertex) for every neighbour that one lattice move or link reaches from `vertex`.
  template <class Visit>
  void for_each_neighbour(int vertex, Visit&& visit) const {
    if (own_.contains(vertex)) {
      for (const int link : own_.links(vertex)) visit(link);
      return;
    }
    std::uint32_t mask = vertex < lattice_.vertex_count() ? free_space_.steps_from(vertex) : 0;
    for (std::size_t k = 0; mask != 0; ++k, mask >>= 1) {
      if ((mask & 1u) != 0)
        visit(vertex + lattice_.steps()[k].rows * lattice_.columns() + lattice_.steps()[k].columns);
    }
    for (const auto& [from, to] : finer_.links_from(vertex)) visit(to);
    own_.for_each_link_from(vertex, visit);
  }

 private:
  Vertices(const Instance& instance, std::size_t robot, std::size_t stage);

  bool is_free(int from, int to) const;

  MoveTimes times_;
  const DriveZones* zones_;  // that limit how the robot drives; null if there are none
  const Lattice& lattice_;
  FreeSpace& free_space_;
  const FinerVertices& finer_;
  bool any_angle_;
  OwnVertices own_;
  int start_ = -1;
  std::vector<GoalPose> goals_;
  bool finished_ = true;
};

}  // namespace fleetplan::core
