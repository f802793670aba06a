#pragma once

// The static side of a search for one robot.

#include <cstddef>
#include <memory>
#include <vector>

#include "core/compile/views.h"
#include "core/geometry/segment.h"
#include "core/model/itinerary.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

class Instance;

/// The static side of one robot's search:
///
/// - where and when its plan begins,
/// - its goals,
/// - its view of the static map,
/// - and the costs to go to each of its goals.
class SearchSpace {
 public:
  /// If `stop` is met first, the space is not finished() and must not be used.
  SearchSpace(const Instance& instance, std::size_t robot, const StopCondition& stop);
  /// With another itinerary than in the instance, but with the same beginning. For a robot with one load.
  SearchSpace(const Instance& instance, std::size_t robot, Itinerary itinerary, const StopCondition& stop);
  /// For similar robots, one after the other, on their ways to the same goal. They share the costs to go.
  /// begin_at() makes it the space of a robot, which has no commitments and one load.
  SearchSpace(const Instance& instance, std::size_t robot, const Goal& goal);
  /// `any_heading`: the robot starts with the heading that suits it best.
  void begin_at(std::size_t robot, bool any_heading);
  SearchSpace(const SearchSpace&) = delete;
  SearchSpace& operator=(const SearchSpace&) = delete;

  bool finished() const { return vertices_.back().vertices->finished(); }

  /// The plan goes on from here, after the committed actions; seconds.
  double t_begin() const { return itinerary_.t_begin; }
  /// The motion of the robot until then.
  const Trajectory& committed() const { return itinerary_.committed; }
  /// The heading of the robot then.
  double heading_at_start() const { return itinerary_.pose.theta; }
  /// The first move needs no rotation, whatever the heading is.
  bool any_heading_at_start() const { return any_heading_at_start_; }
  /// Whether the committed actions end at rest in the pose of the first goal. Then the rest begins at
  /// arrived(), and service_done() of the service is done; seconds. It counts until the robot leaves.
  bool begins_in_goal_pose() const { return begins_in_goal_pose_; }
  double arrived() const { return itinerary_.arrived; }
  double service_done() const { return itinerary_.service_done; }
  /// Whether the robot can serve all its goals without moving.
  bool all_goals_at_start() const { return goals_at_start_ == goal_count(); }

  /// In the first stage, on the way to the first goal that is left.
  const Vertices& vertices() const { return *vertices_.front().vertices; }
  /// In a stage: the robot has one view for each of its loads.
  const Vertices& vertices(std::size_t stage) const { return *numbered(stage).vertices; }
  /// The number of the first vertex of this stage's view, if the vertices of all views are numbered together.
  int first_vertex(std::size_t stage) const { return numbered(stage).first_vertex; }
  /// Vertices of all views.
  int vertex_count() const { return vertices_.back().first_vertex + vertices_.back().vertices->count(); }

  /// The goals that are left.
  std::size_t goal_count() const { return itinerary_.goals.size(); }
  /// The goal at the end of a stage, and its pose.
  const Goal& goal(std::size_t stage) const { return itinerary_.goals[stage]; }
  const Vertices::GoalPose& goal_pose(std::size_t stage) const { return vertices(stage).goals()[stage]; }
  /// The number of this goal among all goals of the robot, see Visit.
  std::size_t number_of_goal(std::size_t stage) const { return itinerary_.first_goal + stage; }
  /// Where a stage begins: the start, or the goal before.
  int begin_of(std::size_t stage) const {
    return stage == 0 ? vertices().start() : vertices(stage).goals()[stage - 1].vertex;
  }

  bool changes_load() const { return views_->change(); }
  /// Whether the robot has another radius at rest at the last goal, after its service.
  bool rests_with_other_radius() const {
    return changes_load() && wall_radius(goal_count()) != wall_radius(goal_count() - 1);
  }
  /// The radius to walls in a stage, metres, inflation included. With goal_count(): at rest at the last goal.
  double wall_radius(std::size_t stage) const { return (*views_)[stage].body.wall_radius; }
  Footprint footprint(std::size_t stage) const {
    return {robot_, (*views_)[stage].body.radius, stage > goals_at_start_};
  }

  /// To the goal with this index in Vertices::goals(), created on first use. Equal goals share their costs.
  CostToGo& cost_to_go(std::size_t goal);

  /// Approximate memory in use, bytes.
  std::size_t bytes() const;

 private:
  /// The vertices of one view.
  struct Numbered {
    std::unique_ptr<Vertices> vertices;
    int first_vertex = 0;
  };

  const Numbered& numbered(std::size_t stage) const { return vertices_[views_->number(stage)]; }
  void find_goals(const StopCondition& stop);
  void add_vertices(const StopCondition& stop);
  void find_equal_goals();

  const Instance& instance_;
  std::size_t robot_;
  const Views* views_;
  Itinerary own_itinerary_;  // if it differs from the instance's
  const Itinerary& itinerary_;
  bool any_heading_at_start_ = false;
  std::vector<Numbered> vertices_;  // one for each view, by its number
  bool begins_in_goal_pose_ = false;
  std::size_t goals_at_start_ = 0;                      // the first so many, which need no move
  std::vector<std::size_t> first_equal_;                // by goal
  std::vector<std::unique_ptr<CostToGo>> costs_to_go_;  // by goal; equal goals use the first of them
};

}  // namespace fleetplan::core
