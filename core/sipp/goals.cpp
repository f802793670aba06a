#include "core/sipp/goals.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/sipp/moves.h"

namespace fleetplan::core {
namespace {

/// Ways that are estimated between two checks of the stop condition.
constexpr std::size_t kGoalsBetweenPolls = 16;
/// Seconds; far more than the tolerances of times and headings with which a rest counts as a service.
constexpr double kClearlyBefore = 1e-3;

/// Estimates the way from one goal to the next one, seconds. A heading that is free is the best one.
double estimated_leg(SearchSpace& space, std::size_t from, const StopCondition& stop) {
  const Body& body = space.vertices().body();
  const Vertices::GoalPose& here = space.vertices(from + 1).goals()[from];
  const Vertices::GoalPose& next = space.goal_pose(from + 1);
  if (here.vertex == next.vertex) {
    return here.heading && next.heading ? body.rotation_time(*here.heading, *next.heading) : 0.0;
  }
  const CostToGo::Estimate estimate = space.cost_to_go(from + 1).from(here.vertex, stop);
  return here.heading ? estimate.with_rotation(*here.heading, body) : estimate.least();
}

/// A stage with the load that the robot carries in it.
Stage stage_at(const SearchSpace& space, std::size_t index) {
  Stage stage;
  stage.vertices = &space.vertices(index);
  stage.first_vertex = space.first_vertex(index);
  stage.footprint = space.footprint(index);
  return stage;
}

/// The stages of a robot with a goal, without the releases; none if `stop` is met first.
IndexedVector<Stage> stages_of(SearchSpace& space, const StopCondition& stop) {
  IndexedVector<Stage> stages(space.goal_count());
  const int last = static_cast<int>(space.goal_count()) - 1;
  StopStride stride(stop, kGoalsBetweenPolls);
  for (int k = last; k >= 0; --k) {
    if (stride.met_at_step()) return {};
    const auto index = static_cast<std::size_t>(k);
    const Goal& goal = space.goal(index);
    stages[k] = stage_at(space, index);
    Stage& stage = stages[k];
    stage.goal_pose = space.goal_pose(index);
    stage.service = goal.service;
    stage.not_before = goal.not_before;
    stage.after = goal.service;
    stage.is_anywhere = goal.anywhere;
    stage.radius_changes = space.changes_load() && space.wall_radius(index) != space.wall_radius(index + 1);
    if (k < last) stage.after += estimated_leg(space, index, stop) + stages[k + 1].after;
  }
  if (!space.rests_with_other_radius()) return stages;
  Stage rest = stage_at(space, space.goal_count());
  rest.goal_pose = rest.vertices->goals().back();
  rest.is_rest = true;
  stages.push_back(rest);
  return stages;
}

/// `last_free_from`: when the last goal becomes free for good, seconds.
void set_releases(IndexedVector<Stage>& stages, double last_free_from) {
  double release = stages.back().service_end(last_free_from);
  for (int k = static_cast<int>(stages.size()) - 1; k >= 0; --k) {
    const bool is_last = &stages[k] == &stages.back();
    if (!is_last) release = std::max(release, stages[k].not_before + stages[k].after);
    stages[k].release = release;
  }
}

}  // namespace

std::optional<double> estimated_end(SearchSpace& space, const StopCondition& stop) {
  IndexedVector<Stage> stages = stages_of(space, stop);
  if (stages.empty()) return std::nullopt;
  set_releases(stages, 0.0);
  const Stage& first = stages[0];
  const int start = space.vertices().start();
  const bool leaves = start != first.goal_pose.vertex;
  const double leg = leaves ? space.cost_to_go(0).from(start, stop).least() : 0.0;
  return std::max(first.release, space.t_begin() + leg + first.after);
}

Goals::Goals(SearchSpace& space, double horizon, SearchState& state)
    : space_(space),
      horizon_(horizon),
      state_(state),
      changes_load_(space.changes_load()),
      last_stage_(static_cast<int>(space.goal_count()) - (space.rests_with_other_radius() ? 0 : 1)),
      ends_anywhere_(space.goal(space.goal_count() - 1).anywhere) {}

bool Goals::begin(const StopCondition& stop) {
  stages_ = stages_of(space_, stop);
  last_ = PlaceId::none;
  return !stages_.empty();
}

bool Goals::end_at(PlaceId place) {
  last_ = place;
  if (ends_anywhere_) {
    set_releases(stages_, 0.0);
    return true;
  }
  const Place& goal = state_.places[place];
  const bool stays_free = !goal.never_safe() && state_.intervals[goal.end_interval - 1].end == kForever;
  const double free_from = stays_free ? state_.intervals[goal.end_interval - 1].begin : kForever;
  if (!stays_free && !has_horizon()) return false;
  set_releases(stages_, std::min(free_from, horizon_));
  return true;
}

bool Goals::can_serve(int stage, const Place& place) const {
  const double done = stage == 0 ? space_.service_done() : 0.0;
  for (int k = place.first_interval; k < place.end_interval; ++k) {
    const SafeInterval& safe = state_.intervals[k];
    if (stages_[stage].service_end(safe.begin) - done <= safe.end) return true;
  }
  return false;
}

ServiceStop Goals::service_stop(const Label& label) const {
  const Stage& stage = stages_[state_.places[label.place].stage];
  const bool at_start = label.parent == LabelId::none;
  ServiceStop stop{label.arrival, 0.0, label.heading};
  if (at_start && space_.begins_in_goal_pose()) {
    stop.t_rest = space_.arrived();
  } else {
    if (at_start) stop.t_rest = space_.t_begin();  // also if it has to stay there for longer
    if (stage.goal_pose.heading) {
      const Position place = stage.vertices->position(stage.goal_pose.vertex);
      stop.t_rest += stage.vertices->times().rotation_time(place, label.heading, *stage.goal_pose.heading);
      stop.heading = *stage.goal_pose.heading;
    }
  }
  stop.t_end = stage.service_end(stop.t_rest);
  return stop;
}

double Goals::latest_departure(const Label& label) const {
  const Place& place = state_.places[label.place];
  const double safe_until = state_.intervals[label.interval].end;
  if (place.stage + 1 >= static_cast<int>(space_.goal_count())) return safe_until;
  if (!touches_goal(place)) return safe_until;
  return std::min(safe_until, service_stop(label).t_end - kClearlyBefore);
}

bool Goals::may_rest_at(const Label& label) const {
  if (state_.intervals[label.interval].end != kForever) return false;
  if (!changes_load_) return true;
  const Place& place = state_.places[label.place];
  return !place.is_window && !touches_goal(place);
}

bool Goals::touches_goal(const Place& place) const {
  const Stage& stage = stages_[place.stage];
  const Position goal = stage.vertices->position(stage.goal_pose.vertex);
  return (place.position - goal).norm() <= kContactTolerance;
}

namespace {

/// Seconds: rounding of what is left of a way. A move gains far more.
constexpr double kNoGain = 1e-6;

/// Whether a move goes on at the speed of the one before.
bool goes_on(const TimedMove& before, const TimedMove& move, const MoveTimes& times) {
  constexpr double kSameSpeed = 1e-9;  // relative; far above rounding
  if (!times.have_parts()) return true;
  if (move.profile) return false;
  const double speed = before.path.length() / before.duration();
  return std::abs(speed - times.linear_speed(move.path.at(0.5))) <= kSameSpeed * speed;
}

/// Makes the trajectory of a path of labels: the moves between them, the visits to the goals and the cost.
class PathToTrajectory {
 public:
  PathToTrajectory(const Goals& goals, const SearchSpace& space, const SearchState& state)
      : goals_(goals), space_(space), state_(state), trajectory_(space.committed()) {}

  Trajectory to(LabelId end);

 private:
  std::vector<LabelId> path_to(LabelId last) const;
  void append_move(const Label& from, const Label& to);
  void append_service(const Label& from, const Label& to);
  void stop_at_rest(const Label& first, const Label& last);
  double time_left(const Label& label) const;
  double end_after_rest(const Label& label, double t) const;
  std::vector<Visit> visits_after_rest(const Label& label, double t) const;

  const Goals& goals_;
  const SearchSpace& space_;
  const SearchState& state_;
  Trajectory trajectory_;
};

Trajectory PathToTrajectory::to(LabelId end) {
  const std::vector<LabelId> path = path_to(end);
  if (trajectory_.moves.empty()) trajectory_.start = state_.place_at(path.front()).position;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Label& from = state_.labels[path[i - 1]];
    const Label& to = state_.labels[path[i]];
    if (to.by_translation) {
      append_move(from, to);
    } else {
      append_service(from, to);
    }
  }
  const Label& last = state_.labels[end];
  if (!goals_.is_end(last.place, last.interval)) {
    stop_at_rest(state_.labels[path.front()], last);
  } else if (goals_.stage(goals_.last_stage()).is_rest) {
    trajectory_.cost = trajectory_.last_served;
  } else {
    trajectory_.cost = std::max(goals_.service_stop(last).t_end, last.arrival);
  }
  return std::move(trajectory_);
}

/// The labels from the start to `last`.
std::vector<LabelId> PathToTrajectory::path_to(LabelId last) const {
  std::vector<LabelId> path;
  for (LabelId id = last; id != LabelId::none; id = state_.labels[id].parent) path.push_back(id);
  std::reverse(path.begin(), path.end());
  return path;
}

/// A move that continues straight without a stop, at the same speed, is joined to the one before.
void PathToTrajectory::append_move(const Label& from, const Label& to) {
  const bool continues = from.by_translation && to.departure == from.arrival && from.reverse == to.reverse &&
                         angle_between(from.heading, to.heading) <= kSameHeading;
  const Segment way{state_.places[from.place].position, state_.places[to.place].position};
  const MoveTimes& times = goals_.stage(state_.places[to.place].stage).vertices->times();
  std::vector<TimedMove> moves = timed_moves(times, way, to.departure, to.arrival, to.reverse);
  moves.front().continues = continues;
  auto first = moves.begin();
  if (continues && goes_on(trajectory_.moves.back(), *first, times)) {
    trajectory_.moves.back().path.to = first->path.to;
    trajectory_.moves.back().t_end = first->t_end;
    ++first;
  }
  trajectory_.moves.insert(trajectory_.moves.end(), first, moves.end());
}

void PathToTrajectory::append_service(const Label& from, const Label& to) {
  const int stage = state_.places[from.place].stage;
  const ServiceStop stop = goals_.service_stop(from);
  if (state_.places[to.place].stage == static_cast<int>(space_.goal_count())) {
    trajectory_.last_served = std::max(stop.t_end, space_.t_begin());
    return;
  }
  trajectory_.visits.push_back(
      {space_.number_of_goal(static_cast<std::size_t>(stage)), stop.t_rest, stop.t_end});
}

/// Ends a path from the first of these labels at rest in the last one, beyond the horizon.
void PathToTrajectory::stop_at_rest(const Label& first, const Label& last) {
  const double t_begin = space_.t_begin();
  const double t_end = std::max(last.arrival, goals_.horizon());
  trajectory_.stops_at = t_end;
  trajectory_.cost = end_after_rest(last, t_end);
  trajectory_.estimated_visits = visits_after_rest(last, t_end);
  // A robot that waits for the `not_before` of a goal gains time. A robot that has served its goals need not.
  const double left_at_begin = end_after_rest(first, t_begin) - t_begin;
  trajectory_.gains_nothing =
      t_end > t_begin && left_at_begin > kNoGain && trajectory_.cost - t_end >= left_at_begin - kNoGain;
}

/// Estimate: seconds from rest in this label to the end of the last service, without waiting for any
/// `not_before`.
double PathToTrajectory::time_left(const Label& label) const {
  const Place& place = state_.places[label.place];
  return place.any_heading ? place.estimate.seconds
                           : place.estimate.with_rotation(label.heading, space_.vertices().body());
}

/// Estimates when a robot that rests in this label until `t` ends its last service, seconds.
double PathToTrajectory::end_after_rest(const Label& label, double t) const {
  double end = t + time_left(label);
  for (int k = state_.places[label.place].stage; k <= goals_.last_stage(); ++k) {
    end = std::max(end, goals_.stage(k).not_before + goals_.stage(k).after);
  }
  return end;
}

/// Estimates the visits that are left to a robot that rests in this label until `t`.
std::vector<Visit> PathToTrajectory::visits_after_rest(const Label& label, double t) const {
  const auto count = static_cast<int>(space_.goal_count());
  const int first = state_.places[label.place].stage;
  std::vector<Visit> visits;
  double t_arrive = t;
  for (int k = first; k < count; ++k) {
    const Stage& stage = goals_.stage(k);
    const double way = k == first ? time_left(label) - stage.after
                                  : goals_.stage(k - 1).after - goals_.stage(k - 1).service - stage.after;
    t_arrive += std::max(0.0, way);  // not less by rounding
    const double t_leave = stage.service_end(t_arrive);
    visits.push_back({space_.number_of_goal(static_cast<std::size_t>(k)), t_arrive, t_leave});
    t_arrive = t_leave;
  }
  return visits;
}

}  // namespace

Trajectory Goals::trajectory_to(LabelId end) const { return PathToTrajectory(*this, space_, state_).to(end); }

}  // namespace fleetplan::core
