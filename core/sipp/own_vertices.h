#pragma once

// What a robot adds to the lattice: where its plan begins and ends, if that is no vertex.

#include <cstddef>
#include <limits>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/lattice.h"

namespace fleetplan::core {

class Instance;

/// One robot's start and goals where they lie off its lattice (refined for its radius), numbered after the
/// vertices of that, which they are linked to: to all in sight within two spacings. A start or goal that is
/// too near to a wall or to another robot's start is an own vertex, too. At such a vertex the robot keeps the
/// distance from walls that it has there, and from a start it is linked to vertices that are far enough away
/// to be clear. A start that is too near to a wall is left once, and never entered again. So are the start
/// inside of a zone that the robot may leave, and the places on its way out (see Leaving), which are own
/// vertices, each linked to the next one only.
class OwnVertices {
 public:
  /// With the load of the robot in a stage, see RobotStages. `instance` outlives this object.
  OwnVertices(const Instance& instance, std::size_t robot, std::size_t stage);

  /// Adds the place where the plan of this robot begins, if the lattice lacks it; returns its vertex.
  int add_start(std::size_t robot);
  /// Removes what the latest call, add_start(), has added.
  void remove_start();
  /// Adds a goal of this robot, if it is neither on the lattice nor known; returns its vertex.
  int add_goal(std::size_t robot, const Position& goal);

  /// Vertices from here on are own ones.
  int first() const { return first_; }
  /// One past the last vertex.
  int end() const { return first_ + static_cast<int>(own_.size()); }
  bool contains(int vertex) const { return vertex >= first_; }
  const Position& position(int vertex) const { return at(vertex).position; }
  /// The neighbours of an own vertex, ascending.
  const std::vector<int>& links(int vertex) const { return at(vertex).links; }
  /// Calls visit(own) for the own vertices that are neighbours of a vertex of the lattice.
  template <class Visit>
  void for_each_link_from(int vertex, Visit&& visit) const {
    for (std::size_t k = 0; k < own_.size(); ++k) {
      if (is_linked(own_[k], vertex)) visit(first_ + static_cast<int>(k));
    }
  }

  /// Returns whether obstacles leave the straight line between two vertices, at least one of which is an own
  /// one, free for the robot.
  bool is_free(int from, int to) const;
  /// Whether the straight move leads back to a start that is only left.
  bool leads_back(int from, int to) const { return to == never_entered_ && from != to; }
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
  // The own vertices on the way out of zones, the start included, and the vertex at which that ends.
  int first_inside_ = std::numeric_limits<int>::max();
  int end_inside_ = 0;
  int outside_ = -1;
  int never_entered_ = -1;  // the start, if it is too near to a wall
};

}  // namespace fleetplan::core
