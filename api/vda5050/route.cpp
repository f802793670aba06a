#include "api/vda5050/route.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/execution/executed_actions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::api {

namespace {

using core::Action;

bool moves(const Action& action) {
  return action.type == Action::Type::translate && action.from.position != action.to.position;
}

class RouteMaker {
 public:
  RouteMaker(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
             double wait_before_move, const RouteStart& start)
      : robot_(robot),
        actions_(actions),
        start_(start),
        purposes_(core::wait_purposes(robot, actions, wait_before_move)),
        cut_(cuts.begin()),
        cuts_end_(cuts.end()) {}

  Route run() {
    if (actions_.empty() && !start_.is_known) return {};
    route_.first_sequence_id = start_.sequence_id;
    const core::Pose pose = start_pose();
    heading_ = pose.theta;
    const core::ActionPlace at{start_.action, 0.0};
    route_.nodes.push_back({pose.position, heading_, at, {}, at});
    rotation_speed_ = robot_.angular_speed;
    for (std::size_t k = start_.action; k < actions_.size(); ++k) {
      if (moves(actions_[k])) {
        translate(k);
      } else {
        stand(k);
      }
    }
    if (!is_first() || turned_) assume_heading();
    return std::move(route_);
  }

 private:
  RouteNode& last() { return route_.nodes.back(); }
  bool is_first() const { return route_.nodes.size() == 1; }

  core::Pose start_pose() const {
    if (start_.action > 0) return actions_[start_.action - 1].to;
    return actions_.empty() ? robot_.start : actions_.front().from;
  }

  void stand(std::size_t k) {
    const Action& action = actions_[k];
    if (action.type == Action::Type::rotate) {
      const double angle = std::abs(core::normalize_angle(action.to.theta - heading_));
      const double duration = action.t_end - action.t_start;
      if (action.profile) {
        rotation_speed_ = action.profile->cruise;
      } else if (duration > 0.0) {
        rotation_speed_ = std::min(robot_.angular_speed, angle / duration);
      }
      heading_ = action.to.theta;
      turned_ = true;
      turned_until_ = {k + 1, 0.0};
    } else if (action.goal && *action.goal < robot_.goal_count()) {
      serve(*action.goal, purposes_[k].least);
      last().until = {k + 1, 0.0};
    } else if (purposes_[k].least > 0.0) {
      assume_heading();
      last().stops.push_back({{}, purposes_[k].least, 0.0});
      last().until = {k + 1, 0.0};
    }
  }

  /// Adds the service at a goal. `duration`: of the service, or of an added wait that ends with it.
  void serve(std::size_t number, double duration) {
    assume_heading();
    const core::Goal& goal = robot_.goal_at(number);
    std::vector<Stop>& stops = last().stops;
    if (stops.empty() || stops.back().goal != number) stops.push_back({number, 0.0, goal.not_before});
    stops.back().duration = std::min(goal.service, stops.back().duration + duration);
    const double more = duration - goal.service;
    if (more > 0.0) stops.insert(stops.end() - 1, {{}, more, 0.0});
  }

  /// Makes the robot assume its present heading at the last node.
  void assume_heading() {
    const bool is_known = is_first() && start_.is_known;
    const bool is_fixed = is_first() || !last().stops.empty();
    if (is_known || (is_fixed && turned_)) {
      const core::Position position = last().position;
      const core::ActionPlace at = last().at;
      route_.edges.push_back({0.0, 0.0, rotation_speed_, false});
      route_.nodes.push_back({position, {}, at, {}, at});
    }
    last().theta = heading_;
    if (turned_) last().until = turned_until_;
    turned_ = false;
  }

  void translate(std::size_t k) {
    const Action& action = actions_[k];
    if (turned_ && !is_first() && last().stops.empty()) assume_heading();
    for (; cut_ != cuts_end_ && *cut_ <= core::ActionPlace{k, 0.0}; ++cut_) continue;
    double done = 0.0;
    for (; cut_ != cuts_end_ && cut_->action == k; ++cut_) {
      add_leg(action, done, cut_->fraction, *cut_);
      done = cut_->fraction;
    }
    add_leg(action, done, 1.0, {k + 1, 0.0});
    turned_ = false;
    heading_ = action.to.theta;
    rotation_speed_ = robot_.angular_speed;
  }

  void add_leg(const Action& action, double from, double to, const core::ActionPlace& end) {
    const core::Position way = action.to.position - action.from.position;
    const double duration = action.t_end - action.t_start;
    const double constant = duration > 0.0 ? way.norm() / duration : robot_.linear_speed;
    const double speed = action.profile ? action.profile->cruise : constant;
    route_.edges.push_back({(to - from) * way.norm(), speed, rotation_speed_, action.reverse});
    const core::Position position =
        to == 1.0 ? action.to.position : core::Position(action.from.position + to * way);
    route_.nodes.push_back({position, {}, end, {}, end});
  }

  const core::Robot& robot_;
  core::Actions actions_;
  const RouteStart& start_;
  std::vector<core::WaitPurpose> purposes_;  // by action
  std::vector<core::ActionPlace>::const_iterator cut_;
  std::vector<core::ActionPlace>::const_iterator cuts_end_;
  Route route_;
  double heading_ = 0.0;
  bool turned_ = false;  // it has turned since the last node's heading was fixed
  core::ActionPlace turned_until_;
  double rotation_speed_ = 0.0;
};

}  // namespace

std::optional<std::size_t> Route::node_of(std::uint64_t sequence_id) const {
  if (sequence_id < first_sequence_id || (sequence_id - first_sequence_id) % 2 != 0) return std::nullopt;
  const std::uint64_t node = (sequence_id - first_sequence_id) / 2;
  return node < nodes.size() ? std::optional(static_cast<std::size_t>(node)) : std::nullopt;
}

Route route_of(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
               double wait_before_move, const RouteStart& start) {
  return RouteMaker(robot, actions, cuts, wait_before_move, start).run();
}

std::vector<core::ActionPlace> with_points_within(double seconds, std::vector<core::ActionPlace> points,
                                                  core::Actions actions, core::Work& work) {
  constexpr std::size_t kWorkOfAPoint = 256;  // of the node that it becomes
  for (std::size_t k = 0; k < actions.size(); ++k) {
    if (!moves(actions[k])) continue;
    const double pieces = std::ceil((actions[k].t_end - actions[k].t_start) / seconds);
    for (double piece = 1.0; piece < pieces; piece += 1.0) {
      if (work.met_after(kWorkOfAPoint)) return points;
      points.push_back({k, core::share_covered(actions[k], piece / pieces)});
    }
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

namespace {

constexpr core::ActionPlace kNever{std::numeric_limits<std::size_t>::max(), 0.0};

/// The planned time at which a robot comes to a place.
double time_of(core::Actions actions, const core::ActionPlace& place) {
  if (actions.empty()) return 0.0;
  if (place.fraction > 0.0) return core::planned_time(actions, place.action, place.fraction);
  return place.action == 0 ? actions.front().t_start : actions[place.action - 1].t_end;
}

/// The place of a fraction of a translation. If it is nearer to an end than rounding, the end.
core::ActionPlace place_in(const core::ActionProgress& progress, double length) {
  const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
  if (fraction * length <= core::kSamePosition) return {progress.action, 0.0};
  if ((1.0 - fraction) * length <= core::kSamePosition) return {progress.action + 1, 0.0};
  return {progress.action, fraction};
}

/// The place that is earlier, or later, in a translation by this time (seconds), or by kClearance if that is
/// nearer.
core::ActionPlace moved(const core::ActionProgress& progress, core::Actions actions, double seconds) {
  constexpr double kClearance = 0.01;  // metres
  const core::ActionPlace place = core::place_of(progress);
  if (place.fraction <= 0.0 || actions[place.action].type != core::Action::Type::translate) return place;
  const core::Action& action = actions[place.action];
  const double duration = action.t_end - action.t_start;
  const double length = (action.to.position - action.from.position).norm();
  if (duration <= 0.0 || length <= 0.0) return place;
  const double most = kClearance / length;
  double change = seconds / duration;
  if (action.profile) {
    const double planned = core::planned_time(actions, place.action, place.fraction) - action.t_start;
    const double elapsed = std::clamp((planned + seconds) / duration, 0.0, 1.0);
    change = core::share_covered(action, elapsed) - place.fraction;
  }
  change = std::clamp(change, -most, most);
  return place_in({progress.robot, progress.action, progress.fraction + change}, length);
}

}  // namespace

std::vector<Gate> gates_of(const std::vector<core::Dependency>& dependencies,
                           const std::vector<core::Actions>& actions) {
  constexpr double kShare = 0.25;  // of the slack
  std::vector<Gate> gates;
  gates.reserve(dependencies.size());
  for (const core::Dependency& dependency : dependencies) {
    const core::ActionProgress& gate = dependency.gate;
    const core::ActionProgress& until = dependency.until;
    const double time = kShare * dependency.slack;
    gates.push_back({gate.robot, moved(gate, actions[gate.robot], -time), until.robot,
                     moved(until, actions[until.robot], time)});
  }
  return gates;
}

std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<Gate>& gates, std::size_t robots) {
  std::vector<std::vector<core::ActionPlace>> points(robots);
  for (const Gate& gate : gates) {
    points[gate.robot].push_back(gate.place);
    points[gate.other].push_back(gate.until);
  }
  for (auto& of_robot : points) {
    std::sort(of_robot.begin(), of_robot.end());
    of_robot.erase(std::unique(of_robot.begin(), of_robot.end()), of_robot.end());
  }
  return points;
}

std::vector<core::ActionPlace> closed_gates(const std::vector<Gate>& gates,
                                            const std::vector<core::ActionPlace>& progress) {
  std::vector<core::ActionPlace> closed(progress.size(), kNever);
  for (const Gate& gate : gates) {
    if (gate.until <= progress[gate.other]) continue;
    closed[gate.robot] = std::min(closed[gate.robot], gate.place);
  }
  return closed;
}

std::size_t released_nodes(const Route& route, const core::ActionPlace& closed) {
  const auto is_open = [&](const RouteNode& node) { return node.at <= closed; };
  const auto end = std::partition_point(route.nodes.begin(), route.nodes.end(), is_open);
  return std::max<std::size_t>(1, static_cast<std::size_t>(end - route.nodes.begin()));
}

std::size_t nodes_within(double seconds, const Route& route, core::Actions actions,
                         const core::ActionPlace& progress) {
  const double end = time_of(actions, progress) + seconds;
  const auto is_within = [&](const RouteNode& node) {
    return node.at <= progress || time_of(actions, node.at) <= end;
  };
  const auto is_behind = [&](const RouteNode& node) { return node.at <= progress; };
  const auto first = route.nodes.begin();
  const auto within = std::partition_point(first, route.nodes.end(), is_within) - first;
  const auto behind = std::partition_point(first, route.nodes.end(), is_behind) - first;
  return std::min(route.nodes.size(), static_cast<std::size_t>(std::max(within, behind + 1)));
}

}  // namespace fleetplan::api
