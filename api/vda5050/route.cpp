#include "api/vda5050/route.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
             double wait_before_move)
      : robot_(robot),
        actions_(actions),
        purposes_(core::wait_purposes(robot, actions, wait_before_move)),
        cut_(cuts.begin()),
        cuts_end_(cuts.end()) {}

  Route run() {
    if (actions_.empty()) return {};
    heading_ = actions_.front().from.theta;
    route_.nodes.push_back({actions_.front().from.position, heading_, {}, {}});
    rotation_speed_ = robot_.angular_speed;
    for (std::size_t k = 0; k < actions_.size(); ++k) {
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

  void stand(std::size_t k) {
    const Action& action = actions_[k];
    if (action.type == Action::Type::rotate) {
      const double angle = std::abs(core::normalize_angle(action.to.theta - heading_));
      const double duration = action.t_end - action.t_start;
      if (duration > 0.0) rotation_speed_ = std::min(robot_.angular_speed, angle / duration);
      heading_ = action.to.theta;
      turned_ = true;
    } else if (action.goal && *action.goal < robot_.goal_count()) {
      serve(*action.goal, purposes_[k].least);
    } else if (purposes_[k].least > 0.0) {
      assume_heading();
      last().stops.push_back({{}, purposes_[k].least, 0.0});
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
    const bool is_fixed = is_first() || !last().stops.empty();
    if (is_fixed && turned_) {
      const core::Position position = last().position;
      const core::ActionPlace at = last().at;
      route_.edges.push_back({0.0, 0.0, rotation_speed_, false});
      route_.nodes.push_back({position, {}, at, {}});
    }
    last().theta = heading_;
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
    const double speed = duration > 0.0 ? way.norm() / duration : robot_.linear_speed;
    route_.edges.push_back({(to - from) * way.norm(), speed, rotation_speed_, action.reverse});
    const core::Position position =
        to == 1.0 ? action.to.position : core::Position(action.from.position + to * way);
    route_.nodes.push_back({position, {}, end, {}});
  }

  const core::Robot& robot_;
  core::Actions actions_;
  std::vector<core::WaitPurpose> purposes_;  // by action
  std::vector<core::ActionPlace>::const_iterator cut_;
  std::vector<core::ActionPlace>::const_iterator cuts_end_;
  Route route_;
  double heading_ = 0.0;
  bool turned_ = false;  // it has turned since the last node's heading was fixed
  double rotation_speed_ = 0.0;
};

}  // namespace

Route route_of(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
               double wait_before_move) {
  return RouteMaker(robot, actions, cuts, wait_before_move).run();
}

std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<core::Dependency>& dependencies,
                                                      std::size_t robots) {
  std::vector<std::vector<core::ActionPlace>> points(robots);
  // Bounded: two places of each dependency.
  for (const core::Dependency& dependency : dependencies) {
    for (const core::ActionProgress& progress : {dependency.gate, dependency.until}) {
      points[progress.robot].push_back(core::place_of(progress));
    }
  }
  for (auto& of_robot : points) {
    std::sort(of_robot.begin(), of_robot.end());
    of_robot.erase(std::unique(of_robot.begin(), of_robot.end()), of_robot.end());
  }
  return points;
}

std::vector<std::size_t> released_nodes(const std::vector<Route>& routes,
                                        const std::vector<core::Dependency>& dependencies,
                                        const std::vector<core::ActionPlace>& progress) {
  constexpr core::ActionPlace kNever{std::numeric_limits<std::size_t>::max(), 0.0};
  std::vector<core::ActionPlace> closed(routes.size(), kNever);  // the first gate that is not open
  for (const core::Dependency& dependency : dependencies) {
    if (core::place_of(dependency.until) <= progress[dependency.until.robot]) continue;
    core::ActionPlace& first = closed[dependency.gate.robot];
    first = std::min(first, core::place_of(dependency.gate));
  }
  std::vector<std::size_t> released;
  released.reserve(routes.size());
  for (std::size_t robot = 0; robot < routes.size(); ++robot) {
    const auto& nodes = routes[robot].nodes;
    const auto is_open = [&](const RouteNode& node) { return node.at <= closed[robot]; };
    const auto end = std::partition_point(nodes.begin(), nodes.end(), is_open);
    released.push_back(static_cast<std::size_t>(end - nodes.begin()));
  }
  return released;
}

}  // namespace fleetplan::api
