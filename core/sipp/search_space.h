#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/instance/instance.h"
#include "core/model/itinerary.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// What a search for one robot needs besides reservations: where and when its plan begins, its goals, its
/// view of the static map, and the costs to go to each of its goals.
class SearchSpace {
 public:
  /// Not finished(), and not to be used, if `stop` is met first.
  SearchSpace(const Instance& instance, std::size_t robot, const StopCondition& stop);

  bool finished() const { return layers_.back().vertices->finished(); }

  const Itinerary& itinerary() const { return itinerary_; }
  /// In its first stage: on the way to the first goal that is left.
  const Vertices& vertices() const { return *layers_.front().vertices; }
  /// In a stage: the robot has one view for each of its radii.
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

  bool changes_radius() const { return instance_.changes_radius(robot_); }
  /// Whether it has another radius at rest at the last goal, after the service there.
  bool rests_with_other_radius() const {
    return changes_radius() && radius(goal_count()) != radius(goal_count() - 1);
  }
  /// Metres, in a stage, or with goal_count() at rest at the last goal.
  double radius(std::size_t stage) const { return instance_.motion(robot_, stage).radius; }
  double narrower(std::size_t stage) const { return instance_.narrower(robot_, stage); }
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
  const std::size_t robot_;
  const Itinerary& itinerary_;
  std::vector<Layer> layers_;                // one for each radius
  std::vector<std::size_t> layer_of_stage_;  // empty if there is one layer
  bool begins_in_goal_pose_;
  std::vector<std::size_t> first_equal_;                // by goal
  std::vector<std::unique_ptr<CostToGo>> costs_to_go_;  // by goal, of the first of equal ones
};

}  // namespace fleetplan::core
