#pragma once

// What a search for one robot needs besides the reservations of others: its view of the static map, its
// goals, and what it costs to get to them. All of it is kept from search to search.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/instance/instance.h"
#include "core/map/lattice.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/cost_to_go.h"

namespace fleetplan::core {

/// One robot's view of the static map: the vertices that it may stop at and the straight moves between them.
/// Vertices are those of the lattice, those that refine it for its radius, and its own start and goals where
/// they lie off the lattice; these are linked to every lattice vertex in sight within two cells. A start or
/// goal that is too near to a wall or to another robot's start is an own vertex, too. At such a vertex the
/// robot keeps the distance from walls that it has there, and from a start it is linked to vertices that are
/// far enough away to be clear. A start that is too near to a wall is left once, and never entered again.
/// So are the start inside of a zone that the robot may leave, and the places on its way out (see Leaving),
/// which are own vertices, each linked to the next one only.
///
/// A robot whose load changes has one view for each of its loads.
class Vertices {
 public:
  /// The view with the load of the robot in a stage: on the way to one of the goals that are left, or at rest
  /// at the last one. See Instance::motion.
  /// If `stop` is met first, the view is not finished() and must not be used.
  Vertices(const Instance& instance, std::size_t robot, std::size_t stage, const StopCondition& stop);
  /// The view with one goal and without a start, until begin_at() gives one: for robots that are alike, one
  /// after the other, on their ways to the same goal.
  Vertices(const Instance& instance, std::size_t robot, const Goal& goal);
  /// Replaces the start by the place where the plan of this robot begins. The vertices from first_late() on
  /// are those of the start.
  void begin_at(const Instance& instance, std::size_t robot);
  int first_late() const { return first_own_ + static_cast<int>(early_own_); }

  bool finished() const { return finished_; }

  const Motion& motion() const { return motion_; }
  /// The zones that limit how the robot drives; null if there are none.
  const DriveZones* zones() const { return zones_; }
  /// The motion with the least angular speed of all zones.
  const Motion& slowest_motion() const { return slowest_motion_; }
  /// Whether the search may leave the lattice's directions.
  bool any_angle() const { return any_angle_; }
  double spacing() const { return lattice_.spacing(); }
  /// The length of a straight line by that of lattice moves between its ends, at least.
  double least_straight() const { return lattice_.least_straight(); }

  int count() const { return first_own_ + static_cast<int>(own_.size()); }
  /// -1 if the robot has another load there.
  int start() const { return start_; }
  /// The end of the committed actions, or the robot's start without any.
  const Pose& start_pose() const { return start_pose_; }
  /// The pose of a goal; without a heading, any will do.
  struct GoalPose {
    int vertex = -1;
    std::optional<double> heading;
    bool operator==(const GoalPose&) const = default;
  };
  /// The poses of the goals that are left to visit, in their order; empty for a parked robot. Goals at which
  /// the robot neither arrives nor leaves with this load have no vertex.
  const std::vector<GoalPose>& goals() const { return goals_; }
  /// The vertex of the last one, -1 for a parked robot.
  int goal() const { return goals_.empty() ? -1 : goals_.back().vertex; }

  Position position(int vertex) const {
    if (vertex < lattice_.vertex_count()) return lattice_.position(vertex);
    return is_own(vertex) ? own_[own_index(vertex)].position : finer_.position(vertex);
  }

  /// From one vertex to another.
  Displacement between(int from, int to) const {
    const bool on_lattice = from < lattice_.vertex_count() && to < lattice_.vertex_count();
    return on_lattice ? lattice_.between(from, to) : Displacement::between(position(from), position(to));
  }

  /// Seconds of the straight move, which is so long, from one vertex to another.
  double translation_time(int from, int to, double length) const {
    return limit_speeds() ? zones_->translation_time(position(from), position(to))
                          : motion_.translation_time(length);
  }
  /// Seconds to turn at a vertex.
  double rotation_time(int vertex, double from, double to) const {
    return limit_speeds() ? motion_.angular_inertia.time(angle_between(from, to),
                                                         zones_->angular_speed_at(position(vertex)))
                          : motion_.rotation_time(from, to);
  }
  /// The pieces of a straight translation from rest to rest, seconds from its beginning: between the borders
  /// of speed zones.
  std::vector<DriveZones::Piece> pieces(const Segment& path) const;
  /// The greatest linear speed at a vertex, metres per second.
  double linear_speed(int vertex) const {
    return limit_speeds() ? zones_->linear_speed_at(position(vertex)) : motion_.linear_speed;
  }
  bool limit_speeds() const { return zones_ != nullptr && zones_->limit_speeds(); }
  /// Returns whether the straight move does not lead back to a start that is too near to a wall, nor into a
  /// zone that the robot has to leave, and one-way zones allow it.
  bool allow(int from, int to) const {
    if (to == never_entered_ && from != to) return false;
    if (is_inside(from) || is_inside(to)) return from == to || leads_out(from, to);
    return zones_ == nullptr || zones_->allow(position(from), position(to));
  }

  /// Returns whether obstacles leave the straight line between two vertices free for the robot (paper,
  /// "Estimating the feasibility of the move w.r.t. static obstacles"), and the move is allowed.
  bool in_sight(int from, int to) const { return is_free(from, to) && allow(from, to); }

  /// Calls visit(vertex) for every neighbour that one lattice move or link reaches from `vertex`.
  template <class Visit>
  void for_each_neighbour(int vertex, Visit&& visit) const {
    if (is_own(vertex)) {
      for (const int link : own_[own_index(vertex)].links) visit(link);
      return;
    }
    std::uint32_t mask = vertex < lattice_.vertex_count() ? free_steps(vertex) : 0;
    for (std::size_t k = 0; mask != 0; ++k, mask >>= 1) {
      if ((mask & 1u) != 0)
        visit(vertex + lattice_.steps()[k].rows * lattice_.columns() + lattice_.steps()[k].columns);
    }
    for (const auto& [from, to] : finer_.links_from(vertex)) visit(to);
    for (std::size_t k = 0; k < own_.size(); ++k) {
      if (linked(own_[k], vertex)) visit(first_own_ + static_cast<int>(k));
    }
  }

 private:
  Vertices(const Instance& instance, std::size_t robot, std::size_t stage);

  bool is_free(int from, int to) const;
  struct OwnVertex {
    Position position;
    double radius = 0.0;     // metres; less than the robot's if a wall is nearer
    double reach = 0.0;      // metres; the longest move to or from it with this radius
    std::vector<int> links;  // ascending
  };

  /// The radius of the robot's disk at a vertex, metres.
  double radius(int vertex) const { return is_own(vertex) ? own_[own_index(vertex)].radius : motion_.radius; }
  bool is_own(int vertex) const { return vertex >= first_own_; }
  /// Whether it is on the way out of zones, and not yet outside.
  bool is_inside(int vertex) const { return vertex >= first_inside_ && vertex < end_inside_; }
  bool leads_out(int from, int to) const {
    return is_inside(from) && to == (from + 1 < end_inside_ ? from + 1 : outside_);
  }
  std::size_t own_index(int vertex) const { return static_cast<std::size_t>(vertex - first_own_); }
  static bool linked(const OwnVertex& own, int vertex);
  int add_start(const Instance& instance, std::size_t robot);
  /// Adds the start and the places on the way out of zones; returns the start.
  int add_way_out(const std::vector<Position>& way);
  int add_goal(const Instance& instance, std::size_t robot, const Position& position);
  /// The vertex of the refined lattice at this position, or -1.
  int vertex_at(const Position& position) const;
  /// An own vertex at this position, or -1.
  int own_vertex_at(const Position& position) const;
  /// Adds an own vertex with links to those within `reach` metres.
  int add_linked(OwnVertex own, double reach);
  /// Where that has no links, adds vertices that lead to others, too.
  int add(const OwnVertex& own, double reach);
  bool may_move(const OwnVertex& own, const Position& to, double radius) const;
  /// Bit k is set if step k of the lattice is free of obstacles.
  std::uint32_t free_steps(int vertex) const;

  const std::size_t stage_;
  const Motion& motion_;
  const DriveZones* zones_;
  Motion slowest_motion_;
  const Lattice& lattice_;
  const OccupancyGrid& grid_;
  FreeSpace& space_;
  const FinerVertices& finer_;
  int first_own_;
  bool any_angle_;
  Pose start_pose_;
  std::vector<OwnVertex> own_;
  std::size_t early_own_ = 0;  // own vertices that begin_at() keeps
  // The own vertices on the way out of zones, the start included, and the vertex at which that ends.
  int first_inside_ = std::numeric_limits<int>::max();
  int end_inside_ = 0;
  int outside_ = -1;
  int start_ = -1;
  int never_entered_ = -1;  // the start, if it is too near to a wall
  std::vector<GoalPose> goals_;
  bool finished_ = true;
};

/// What a search for one robot needs besides reservations: where and when its plan begins, its goals, its
/// view of the static map, and the costs to go to each of its goals.
class SearchSpace {
 public:
  /// If `stop` is met first, the space is not finished() and must not be used.
  SearchSpace(const Instance& instance, std::size_t robot, const StopCondition& stop);
  /// For robots that are alike, one after the other, on their ways to the same goal; they share the costs to
  /// go. begin_at() makes it the space of a robot, which has no commitments and one load.
  SearchSpace(const Instance& instance, std::size_t robot, const Goal& goal);
  /// `any_heading`: the robot has the heading at its start that suits it best.
  void begin_at(std::size_t robot, bool any_heading);
  SearchSpace(const SearchSpace&) = delete;
  SearchSpace& operator=(const SearchSpace&) = delete;

  bool finished() const { return layers_.back().vertices->finished(); }

  const Itinerary& itinerary() const { return itinerary_; }
  /// In its first stage: on the way to the first goal that is left.
  const Vertices& vertices() const { return *layers_.front().vertices; }
  /// In a stage: the robot has one view for each of its loads.
  const Vertices& vertices(std::size_t stage) const { return *layer(stage).vertices; }
  /// Numbers of its vertices among those of all its views begin with this one in a stage.
  int first_vertex(std::size_t stage) const { return layer(stage).first_vertex; }
  /// Vertices of all views.
  int vertex_count() const { return layers_.back().first_vertex + layers_.back().vertices->count(); }
  std::size_t goal_count() const { return itinerary_.goals.size(); }
  /// The pose of the goal at the end of a stage.
  const Vertices::GoalPose& goal(std::size_t stage) const { return vertices(stage).goals()[stage]; }
  /// Where a stage begins: the start, or the goal before.
  int begin_of(std::size_t stage) const {
    return stage == 0 ? vertices().start() : vertices(stage).goals()[stage - 1].vertex;
  }

  bool changes_load() const { return instance_.stages(robot_).changes_load(); }
  /// Whether it has another radius at rest at the last goal, after the service there.
  bool rests_with_other_radius() const {
    return changes_load() && radius(goal_count()) != radius(goal_count() - 1);
  }
  /// The radius in a stage or, with goal_count(), at rest at the last goal; metres, inflation included.
  double radius(std::size_t stage) const { return instance_.stages(robot_)[stage].motion.radius; }
  Footprint footprint(std::size_t stage) const {
    return {robot_, instance_.stages(robot_)[stage].load.radius, stage > goals_at_start_};
  }
  /// Whether the robot need not move for any of its goals.
  bool all_goals_at_start() const { return goals_at_start_ == goal_count(); }
  /// The first move needs no rotation.
  bool any_heading_at_start() const { return any_heading_at_start_; }
  /// The committed actions end at rest in the pose of the first goal.
  bool begins_in_goal_pose() const { return begins_in_goal_pose_; }

  /// To the goal with this index in Vertices::goals(), created on first use. Equal goals share theirs.
  CostToGo& cost_to_go(std::size_t goal);

  /// Expansions of all backward searches so far.
  std::int64_t expansions() const;
  /// Approximate memory in use, bytes.
  std::size_t bytes() const;

 private:
  struct Layer {
    std::unique_ptr<Vertices> vertices;
    int first_vertex = 0;
  };

  const Layer& layer(std::size_t stage) const {
    return layers_[layer_of_stage_.empty() ? 0 : layer_of_stage_[stage]];
  }
  void add_layers(const StopCondition& stop);
  void find_equal_goals();

  const Instance& instance_;
  std::size_t robot_;
  Itinerary own_itinerary_;  // of robots one after the other
  const Itinerary& itinerary_;
  bool any_heading_at_start_ = false;
  std::vector<Layer> layers_;                // one for each load
  std::vector<std::size_t> layer_of_stage_;  // empty if there is one layer
  bool begins_in_goal_pose_;
  std::size_t goals_at_start_ = 0;                      // the first so many, which need no move
  std::vector<std::size_t> first_equal_;                // by goal
  std::vector<std::unique_ptr<CostToGo>> costs_to_go_;  // by goal, of the first of equal ones
};

/// The search spaces of the robots, kept from search to search as far as there is memory: those used least
/// recently are discarded, and computed again when they are needed.
class SearchSpaces {
 public:
  /// `instance` outlives this object.
  explicit SearchSpaces(const Instance& instance);

  /// Returns the search space of a robot, valid until the next call for another robot; null if `stop` is met
  /// before it is made.
  SearchSpace* of(std::size_t robot, const StopCondition& stop);
  void discard_all();

 private:
  struct Entry {
    std::unique_ptr<SearchSpace> space;
    std::int64_t last_use = 0;  // the number of the last call for it
  };

  void make_room();

  const Instance& instance_;
  std::vector<Entry> entries_;  // by robot
  std::int64_t calls_ = 0;
};

}  // namespace fleetplan::core
