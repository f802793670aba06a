#include "api/vda5050/route.h"

#include <algorithm>
#include <cmath>

#include "core/execution/executed_actions.h"
#include "core/geometry/angle.h"

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
                                                  core::Actions actions, core::Work& stop) {
  constexpr std::size_t kWorkOfAPoint = 256;  // of the node that it becomes
  for (std::size_t k = 0; k < actions.size(); ++k) {
    if (!moves(actions[k])) continue;
    const double pieces = std::ceil((actions[k].t_end - actions[k].t_start) / seconds);
    for (double piece = 1.0; piece < pieces; piece += 1.0) {
      if (stop.met_after(kWorkOfAPoint)) return points;
      points.push_back({k, core::share_covered(actions[k], piece / pieces)});
    }
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace fleetplan::api
