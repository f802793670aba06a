#include "core/sipp/label_path.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// The labels from the start to the goal.
std::vector<LabelId> path_to(LabelId last, const SearchState& state) {
  std::vector<LabelId> path;
  for (LabelId id = last; id != LabelId::none; id = state.labels[id].parent) path.push_back(id);
  std::reverse(path.begin(), path.end());
  return path;
}

void append(Trajectory& trajectory, const TimedSegment& move, bool reverse) {
  trajectory.moves.push_back(move);
  if (!reverse) return;
  trajectory.reverse.resize(trajectory.moves.size(), false);
  trajectory.reverse.back() = true;
}

/// Appends the pieces of the move to a label. The first one that continues the last move, at the same speed,
/// is joined to that.
void append_pieces(Trajectory& trajectory, const std::vector<DriveZones::Piece>& pieces, const Label& to,
                   bool continues) {
  constexpr double kSameSpeed = 1e-9;  // relative; far above rounding
  for (const DriveZones::Piece& piece : pieces) {
    const double t_end = &piece == &pieces.back() ? to.arrival : to.departure + piece.end;
    const bool goes_on = continues || &piece != &pieces.front();
    if (goes_on && &piece == &pieces.front()) {
      TimedSegment& last = trajectory.moves.back();
      const double speed = last.path.length() / last.duration();
      if (std::abs(speed - piece.linear_speed) <= kSameSpeed * speed) {
        last.path.to = piece.path.to;
        last.t_end = t_end;
        continue;
      }
    }
    append(trajectory, {piece.path, to.departure + piece.begin, t_end}, to.reverse);
    if (!goes_on) continue;
    trajectory.goes_on.resize(trajectory.moves.size(), false);
    trajectory.goes_on.back() = true;
  }
}

}  // namespace

ServiceStop service_stop(const Label& label, const Stage& stage, const SearchSpace& space) {
  const bool at_start = label.parent == LabelId::none;
  ServiceStop stop{label.arrival, 0.0, label.heading};
  if (at_start && space.begins_in_goal_pose()) {
    stop.t_rest = space.itinerary().arrived;
  } else {
    if (at_start) stop.t_rest = space.itinerary().t_begin;  // also if it has to stay there for longer
    if (stage.goal.heading) {
      stop.t_rest += stage.vertices->rotation_time(stage.goal.vertex, label.heading, *stage.goal.heading);
      stop.heading = *stage.goal.heading;
    }
  }
  stop.t_end = stage.service_end(stop.t_rest);
  return stop;
}

Trajectory trajectory_of(const SearchState& state, const SearchSpace& space) {
  const std::vector<LabelId> path = path_to(state.goal_label, state);
  const auto place_of = [&](const Label& label) -> const Place& { return state.places[label.place]; };
  Trajectory trajectory = space.itinerary().committed;
  if (trajectory.moves.empty()) trajectory.start = place_of(state.labels[path.front()]).position;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Label& from = state.labels[path[i - 1]];
    const Label& to = state.labels[path[i]];
    if (!to.by_translation) {
      const int stage = place_of(from).stage;
      const ServiceStop stop = service_stop(from, state.stages[stage], space);
      if (place_of(to).stage == static_cast<int>(space.goal_count())) {
        trajectory.last_served = std::max(stop.t_end, space.itinerary().t_begin);
        continue;
      }
      trajectory.visits.push_back(
          {space.itinerary().first_goal + static_cast<std::size_t>(stage), stop.t_rest, stop.t_end});
      continue;
    }
    const bool continues = from.by_translation && to.departure == from.arrival &&
                           from.reverse == to.reverse &&
                           angle_between(from.heading, to.heading) <= kSameHeading;
    const Segment way{place_of(from).position, place_of(to).position};
    if (space.vertices().limit_speeds()) {
      append_pieces(trajectory, space.vertices().zones()->pieces(way.from, way.to), to, continues);
    } else if (continues) {
      trajectory.moves.back().path.to = way.to;
      trajectory.moves.back().t_end = to.arrival;
    } else {
      append(trajectory, {way, to.departure, to.arrival}, to.reverse);
    }
  }
  const Label& last = state.labels[path.back()];
  if (state.goal_label == state.rest_label) {
    const Place& place = place_of(last);
    const double left = place.any_heading
                            ? place.estimate.seconds
                            : place.estimate.with_rotation(last.heading, space.vertices().motion());
    trajectory.stops_at = std::max(last.arrival, state.horizon);
    trajectory.cost = *trajectory.stops_at + left;
    return trajectory;
  }
  trajectory.cost = state.stages.back().is_rest
                        ? trajectory.last_served
                        : std::max(service_stop(last, state.stages.back(), space).t_end, last.arrival);
  return trajectory;
}

}  // namespace fleetplan::core
