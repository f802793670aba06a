#include "core/sipp/stage.h"

#include <cstddef>
#include <vector>

namespace fleetplan::core {
namespace {

/// Ways that are estimated between two checks of the stop condition.
constexpr int kGoalsBetweenPolls = 16;

/// Estimates the way from one goal to the next one, seconds. A heading that is free is the best one.
double estimated_leg(SearchSpace& space, std::size_t from, const StopCondition& stop) {
  const Motion& motion = space.vertices().motion();
  const Vertices::GoalPose& here = space.vertices(from + 1).goals()[from];
  const Vertices::GoalPose& next = space.goal(from + 1);
  if (here.vertex == next.vertex) {
    return here.heading && next.heading ? motion.rotation_time(*here.heading, *next.heading) : 0.0;
  }
  const CostToGo::Estimate estimate = space.cost_to_go(from + 1).from(here.vertex, stop);
  return here.heading ? estimate.with_rotation(*here.heading, motion) : estimate.least();
}

}  // namespace

IndexedVector<Stage> stages_of(SearchSpace& space, const StopCondition& stop) {
  const std::vector<Goal>& goals = space.itinerary().goals;
  IndexedVector<Stage> stages(goals.size());
  const int last = static_cast<int>(goals.size()) - 1;
  for (int k = last; k >= 0; --k) {
    if ((last - k) % kGoalsBetweenPolls == kGoalsBetweenPolls - 1 && stop.met()) return {};
    const auto index = static_cast<std::size_t>(k);
    const Goal& goal = goals[index];
    stages[k] = {space.goal(index), goal.service, goal.not_before, goal.service, 0.0};
    stages[k].vertices = &space.vertices(index);
    stages[k].first_vertex = space.first_vertex(index);
    stages[k].narrower = space.narrower(index);
    stages[k].radius_changes = space.changes_radius() && space.radius(index) != space.radius(index + 1);
    if (k < last) stages[k].after += estimated_leg(space, index, stop) + stages[k + 1].after;
  }
  if (!space.rests_with_other_radius()) return stages;
  Stage rest;
  rest.vertices = &space.vertices(goals.size());
  rest.goal = rest.vertices->goals().back();
  rest.first_vertex = space.first_vertex(goals.size());
  rest.narrower = space.narrower(goals.size());
  rest.is_rest = true;
  stages.push_back(rest);
  return stages;
}

double estimated_end(SearchSpace& space, const StopCondition& stop) {
  IndexedVector<Stage> stages = stages_of(space, stop);
  if (stages.empty()) return 0.0;
  set_releases(stages, 0.0);
  const Stage& first = stages[0];
  const int start = space.vertices().start();
  const bool leaves = start != first.goal.vertex;
  const double leg = leaves ? space.cost_to_go(0).from(start, stop).least() : 0.0;
  return std::max(first.release, space.itinerary().t_begin + leg + first.after);
}

void set_releases(IndexedVector<Stage>& stages, double last_free_from) {
  double release = stages.back().service_end(last_free_from);
  for (int k = static_cast<int>(stages.size()) - 1; k >= 0; --k) {
    const bool is_last = &stages[k] == &stages.back();
    if (!is_last) release = std::max(release, stages[k].not_before + stages[k].after);
    stages[k].release = release;
  }
}

}  // namespace fleetplan::core
