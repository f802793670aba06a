#pragma once

// One robot's view of the static map while it carries one load: where it may stop, and which straight moves
// it may make.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/map/lattice.h"
#include "core/model/body.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/moves.h"

namespace fleetplan::core {

class Instance;

/// The start and goals of one robot that lie off its lattice (refined for its radius). They are numbered
/// after the lattice's vertices, and linked to all vertices in sight within two spacings.
///
/// A start or goal that is too near to a wall or to another robot's start is an own vertex, too. At such a
/// vertex, the robot keeps the distance from walls that it has there. From such a start, it is linked to
/// vertices that are far enough away to be clear.
///
/// - A start that is too near to a wall is left once, and never entered again.
/// - A last goal that is too near to a wall is entered once, and never left again, even if both are the same
///   place.
/// - A start inside a zone that the robot may leave is treated like the first kind. So are the places on its
///   way out (see Leaving), which are own vertices, each linked only to the next.
class OwnVertices {
 public:
  /// With the load of the robot in a stage, see Views. `instance` must outlive this object.
  OwnVertices(const Instance& instance, std::size_t robot, std::size_t stage);

  /// Adds the place where the plan of this robot begins, if the lattice lacks it. Returns its vertex.
  int add_start(std::size_t robot);
  /// Removes what the latest call, add_start(), has added.
  void remove_start();
  /// Adds a goal of this robot, if it is neither on the lattice nor known. Returns its vertex. `overlap`: how
  /// far the goal may overlap a wall, metres; more than 0 only for the last goal.
  int add_goal(std::size_t robot, const Position& goal, double overlap);

  /// Vertices from here on are own ones.
  int first() const { return first_; }
  /// One past the last vertex.
  int end() const { return first_ + static_cast<int>(own_.size()); }
  bool contains(int vertex) const { return vertex >= first_; }
  const Position& position(int vertex) const { return at(vertex).position; }
  /// The neighbours of an own vertex, ascending.
  const std::vector<int>& links(int vertex) const { return at(vertex).links; }
  /// Calls visit(own) for the own vertices that are neighbours of a vertex of the lattice.
  template <class Visitor>
  void for_each_link_from(int vertex, Visitor&& visit) const {
    for (std::size_t k = 0; k < own_.size(); ++k) {
      if (is_linked(own_[k], vertex)) visit(first_ + static_cast<int>(k));
    }
  }

  /// Returns whether obstacles leave the straight line between two vertices free for the robot. At least one
  /// of them is an own vertex.
  bool is_free(int from, int to) const;
  /// Whether the straight move leads back to a start that is only left, or away from a goal that is only
  /// entered.
  bool leads_back(int from, int to) const {
    return from != to && (is_only_left(to) || is_only_entered(from));
  }
  bool is_only_left(int vertex) const { return vertex == never_entered_; }
  bool is_only_entered(int vertex) const { return vertex == never_left_; }
  /// Whether a vertex is on the way out of zones, and not yet outside.
  bool is_inside(int vertex) const { return vertex >= first_inside_ && vertex < end_inside_; }
  /// Whether the move follows the way out of zones.
  bool leads_out(int from, int to) const {
    return is_inside(from) && to == (from + 1 < end_inside_ ? from + 1 : outside_);
  }

 private:
  struct OwnVertex {
    Position position;
    double radius = 0.0;     // metres; less than the robot's if a wall is nearer
    double reach = 0.0;      // metres; the longest move to or from it with this radius
    std::vector<int> links;  // ascending
  };

  const OwnVertex& at(int vertex) const { return own_[static_cast<std::size_t>(vertex - first_)]; }
  OwnVertex& at(int vertex) { return own_[static_cast<std::size_t>(vertex - first_)]; }
  static bool is_linked(const OwnVertex& own, int vertex);
  bool may_move(const OwnVertex& own, const Position& to, double radius) const;
  Position position_of_any(int vertex) const;
  int lattice_vertex_at(const Position& position) const;
  int own_vertex_at(const Position& position) const;

  double reach_with(double deficit) const;
  int add_start_at(const Position& position, std::size_t robot);
  int add_way_out(const Position& start, const std::vector<Position>& way);
  int add(const OwnVertex& own, double reach);
  int add_linked(OwnVertex own, double reach);

  const Instance& instance_;
  const std::size_t stage_;
  const double robot_radius_;  // metres
  const Lattice& lattice_;
  const FreeSpace& free_space_;
  const FinerVertices& finer_;
  const int first_;
  std::vector<OwnVertex> own_;
  std::size_t start_count_ = 0;  // own vertices that add_start() has added
  // The own vertices on the way out of zones: the first one, the start included, and the vertex at which the
  // way ends.
  int first_inside_ = std::numeric_limits<int>::max();
  int end_inside_ = 0;
  int outside_ = -1;
  int never_entered_ = -1;  // the start, if it is too near to a wall
  int never_left_ = -1;     // the last goal, if it is too near to a wall
};

/// The vertices that the robot may stop at, and the straight moves between them. There are three kinds:
///
/// - the vertices of the lattice,
/// - vertices that refine it for the robot's radius,
/// - and the robot's own start and goals off the lattice.
///
/// A robot whose load changes has one view for each of its loads.
class Vertices {
 public:
  /// The view with the load of the robot in a stage, see Views. If `stop` is met first, the view is not
  /// finished() and must not be used.
  Vertices(const Instance& instance, std::size_t robot, std::size_t stage, const StopCondition& stop);
  /// With the goals of `itinerary` instead. It begins as in the instance, and the robot has one load.
  Vertices(const Instance& instance, std::size_t robot, const Itinerary& itinerary, std::size_t stage,
           const StopCondition& stop);
  /// The view with one goal and without a start, until replace_start() gives one. For similar robots, one
  /// after the other, on their ways to the same goal.
  Vertices(const Instance& instance, std::size_t robot, const Goal& goal);
  /// Replaces the start by the place where the plan of this robot begins. What it adds to the vertices of the
  /// goal comes last.
  void replace_start(const Instance& instance, std::size_t robot);

  bool finished() const { return finished_; }

  /// The pose of a goal. Without a heading, any heading is right.
  struct GoalPose {
    int vertex = -1;
    std::optional<double> heading;
    bool operator==(const GoalPose&) const = default;
  };
  /// -1 if the robot has another load there.
  int start() const { return start_; }
  /// The poses of the goals that are left to visit, in their order. Empty for a parked robot. A goal has no
  /// vertex if the robot neither arrives at it nor leaves it with this load.
  const std::vector<GoalPose>& goals() const { return goals_; }

  /// How long moves take.
  const MoveTimes& times() const { return times_; }
  const Body& body() const { return times_.body(); }
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

  /// Whether the robot may come to a vertex on its way to a goal. A last goal that is too near to a wall is
  /// on the way to no other goal.
  bool may_visit(int vertex, int goal) const { return vertex == goal || !own_.is_only_entered(vertex); }

  /// Returns whether the straight move is allowed:
  ///
  /// - It does not lead back to a start that is too near to a wall, or away from such a goal.
  /// - It does not lead into a zone that the robot has to leave.
  /// - One-way zones allow it.
  bool allow(int from, int to) const {
    if (own_.leads_back(from, to)) return false;
    if (own_.is_inside(from) || own_.is_inside(to)) return from == to || own_.leads_out(from, to);
    return zones_ == nullptr || zones_->allow(position(from), position(to));
  }

  /// Returns whether the move between two vertices is allowed and obstacles leave it free (paper, "Estimating
  /// the feasibility of the move w.r.t. static obstacles").
  bool in_sight(int from, int to) const { return is_free(from, to) && allow(from, to); }

  /// Calls visit(vertex) for every neighbour that one lattice move or link reaches from `vertex`.
  template <class Visitor>
  void for_each_neighbour(int vertex, Visitor&& visit) const {
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
