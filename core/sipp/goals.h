#pragma once

// The goals of one robot in a search: the stages on the way to them, services, and rests.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/trajectory.h"
#include "core/runtime/arrays.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"

namespace fleetplan::core {

/// A part of the way of a robot. It begins at the goal before, or where the robot's plan begins, and leads to
/// the next goal. If the radius changes after the last service, one more stage follows, in which the robot
/// rests.
struct Stage {
  Vertices::GoalPose goal_pose;
  double service = 0.0;     // seconds
  double not_before = 0.0;  // seconds
  /// Estimate: seconds from rest in the goal's pose to the end of the last service, without waiting for any
  /// `not_before`. The service at this goal is included.
  double after = 0.0;
  /// Estimate: no path ends earlier, because of this `not_before` and the later ones, and because the last
  /// goal must become free. With a horizon that is sooner than that, the horizon counts instead.
  double release = 0.0;

  const Vertices* vertices = nullptr;
  int first_vertex = 0;  // see SearchSpace
  Footprint footprint;
  bool radius_changes = false;  // at the end of this stage
  bool is_rest = false;         // after the last service, with another radius
  bool is_anywhere = false;     // the goal is any place where the robot may stay

  double service_end(double t_rest) const { return std::max(t_rest, not_before) + service; }
};

/// A stop in the pose of a goal.
struct ServiceStop {
  double t_rest;   // seconds; from then on at rest in the pose
  double t_end;    // of the service
  double heading;  // in which the robot leaves
};

/// Estimates when a robot ends its last service, alone on the static map; seconds. None if `stop` is met
/// first.
std::optional<double> estimated_end(SearchSpace& space, const StopCondition& stop);

/// What the search for one robot has to reach: the goals in their order, served, and a rest for good in the
/// end. The rest is at the last goal. With a horizon, it may be wherever the robot may stay from then on.
class Goals {
 public:
  /// `horizon`: see SearchSettings. All arguments outlive this object.
  Goals(SearchSpace& space, double horizon, SearchState& state);

  /// Makes the stages of a pass; false if `stop` is met first.
  bool begin(const StopCondition& stop);
  /// Makes this place, the last goal in the last stage, the end of all paths. Returns whether the robot may
  /// stay there from some time on. With a horizon or a last goal that is anywhere, staying elsewhere counts,
  /// too.
  bool end_at(PlaceId place);
  /// Whether the goal of a stage, which is this place, is ever free long enough to be served.
  bool can_serve(int stage, const Place& place) const;

  int last_stage() const { return last_stage_; }
  const Stage& stage(int k) const { return stages_[k]; }
  /// The place of the last goal.
  PlaceId last() const { return last_; }
  /// Estimate: no path ends earlier, because a goal is not free yet or has to wait. Seconds.
  double release() const { return stages_[0].release; }
  double last_release() const { return stages_.back().release; }

  /// Whether a robot that is here in this interval has reached its end.
  bool is_end(PlaceId place, int interval) const {
    const bool is_last = place == last_ || (ends_anywhere_ && state_.places[place].stage == last_stage_);
    return is_last && state_.intervals[interval].end == kForever;
  }

  /// The service of a robot that has this label at the goal of its stage.
  ServiceStop service_stop(const Label& label) const;
  /// When a robot whose radius changes must leave, seconds. A rest in a goal's pose serves the goal as soon
  /// as it is long enough, even if the search does not intend it. So the robot leaves before the rest is long
  /// enough, or after the service.
  double latest_departure(const Label& label) const;

  bool has_horizon() const { return horizon_ != kForever; }
  double horizon() const { return horizon_; }
  /// Whether the robot may stay for good in this label, wherever it is. False in a goal's pose at which the
  /// radius changes, because the rest would serve the goal.
  bool may_rest_at(const Label& label) const;

  /// The committed moves of the robot and the path of labels to `end`. Moves of the path that continue
  /// straight without a stop are joined.
  Trajectory trajectory_to(LabelId end) const;

 private:
  /// Whether a place touches the goal of its stage.
  bool touches_goal(const Place& place) const;

  SearchSpace& space_;
  const double horizon_;
  SearchState& state_;
  const bool changes_load_;
  const int last_stage_;
  const bool ends_anywhere_;  // in the last stage
  IndexedVector<Stage> stages_;
  PlaceId last_ = PlaceId::none;
};

}  // namespace fleetplan::core
