#pragma once

// What robots do by actions of requests and answers, from their JSON alone: no code of the service.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "tests/api/support/requests.h"

namespace fleetplan::api {

/// The members of a robot that its loads change.
struct OwnLoad {
  double radius = 0.0;
  double linear_speed = 0.0;
  double acceleration = 0.0;  // 0: no limit
  double deceleration = 0.0;

  static OwnLoad of(const Json& robot) {
    const double acceleration = robot.value("linear_acceleration", 0.0);
    return {robot.at("radius"), robot.at("linear_speed"), acceleration,
            robot.value("linear_deceleration", acceleration)};
  }

  OwnLoad after(const Json& goal) const {
    const double faster = goal.value("linear_acceleration_after", acceleration);
    const bool changes = goal.contains("linear_acceleration_after");
    return {goal.value("radius_after", radius), goal.value("linear_speed_after", linear_speed), faster,
            goal.value("linear_deceleration_after", changes ? faster : deceleration)};
  }

  bool operator==(const OwnLoad&) const = default;
};

inline Json own_goals(const Json& robot) {
  if (robot.contains("goal")) return Json::array({robot.at("goal")});
  return robot.value("goals", Json::array());
}

inline bool changes_own_load(const Json& goal) {
  return goal.contains("radius_after") || goal.contains("linear_speed_after") ||
         goal.contains("linear_acceleration_after") || goal.contains("linear_deceleration_after");
}

inline bool own_is_at(const Json& pose, const Json& place) {
  constexpr double kSame = 1e-8;
  const auto apart = [&](const char* key) {
    return std::abs(pose.at(key).get<double>() - place.at(key).get<double>());
  };
  if (apart("x") > kSame || apart("y") > kSame) return false;
  return !place.contains("theta") ||
         std::abs(std::remainder(pose.at("theta").get<double>() - place.at("theta").get<double>(),
                                 2.0 * std::numbers::pi)) <= kSame;
}

inline bool own_serves(const Json& pose, const Json& goal) {
  if (!goal.contains("any_of")) {
    if (!goal.contains("place")) return own_is_at(pose, goal);
    Json at_place = goal;
    at_place.update(goal.at("place"));
    return own_is_at(pose, at_place);
  }
  const Json& poses = goal.at("any_of");
  if (goal.contains("choice")) return own_is_at(pose, poses.at(goal.at("choice").get<std::size_t>()));
  return std::any_of(poses.begin(), poses.end(), [&](const Json& one) { return own_is_at(pose, one); });
}

/// A robot that executes actions, and then stands.
class OwnMotion {
 public:
  OwnMotion(const Json& robot, const Json& actions) : goals_(own_goals(robot)) {
    served_before_last_ = robot.value("idle", "") == "yield" ? goals_.size() : goals_.size() - 1;
    if (goals_.empty()) served_before_last_ = 0;
    loads_.push_back({0.0, OwnLoad::of(robot)});
    x_ = robot.at("start").at("x");
    y_ = robot.at("start").at("y");
    Json start = robot.at("start");
    if (!start.contains("theta")) start["theta"] = 0.0;
    // A robot that is committed to nothing serves nothing before it is planned.
    if (!actions.empty()) rest(start, 0.0);
    for (const Json& action : actions) add(action);
  }

  double until() const { return legs_.empty() ? 0.0 : legs_.back().t_end; }

  double radius_at(double t) const {
    double radius = loads_.front().load.radius;
    for (const Step& step : loads_) {
      if (step.t <= t) radius = step.load.radius;
    }
    return radius;
  }

  /// Sets where it is. `t` must not be less than in the call before.
  void place_at(double t, double& x, double& y) {
    while (now_ < legs_.size() && legs_[now_].t_end <= t) ++now_;
    if (now_ == legs_.size()) {
      x = legs_.empty() ? x_ : legs_.back().x1;
      y = legs_.empty() ? y_ : legs_.back().y1;
      return;
    }
    const double share = legs_[now_].share_at(t);
    x = legs_[now_].x0 + share * (legs_[now_].x1 - legs_[now_].x0);
    y = legs_[now_].y0 + share * (legs_[now_].y1 - legs_[now_].y0);
  }

 private:
  struct Step {
    double t;
    OwnLoad load;
  };

  struct Leg {
    double t_start, t_end, x0, y0, x1, y1;
    bool has_profile = false;
    double start = 0.0, cruise = 0.0, end = 0.0, rise = 0.0, fall = 0.0;  // speeds, then seconds

    double share_at(double t) const {
      const double whole = t_end - t_start;
      if (whole <= 0.0) return 1.0;
      const double tau = std::clamp(t - t_start, 0.0, whole);
      if (!has_profile) return tau / whole;
      const auto covered = [&](double until) {
        const double up = std::min(until, rise);
        const double level = std::clamp(until - rise, 0.0, std::max(0.0, whole - rise - fall));
        const double down = std::max(0.0, until - (whole - fall));
        const double raise = rise > 0.0 ? (cruise - start) / rise : 0.0;
        const double drop = fall > 0.0 ? (cruise - end) / fall : 0.0;
        return up * (start + 0.5 * raise * up) + level * cruise + down * (cruise - 0.5 * drop * down);
      };
      const double all = covered(whole);
      return all > 0.0 ? std::clamp(covered(tau) / all, 0.0, 1.0) : tau / whole;
    }
  };

  void add(const Json& action) {
    const Json& from = action.at("from");
    const Json& to = action.at("to");
    Leg leg{action.at("t_start"), action.at("t_end"), from.at("x"), from.at("y"), to.at("x"), to.at("y")};
    const OwnLoad& load = loads_.back().load;
    if (action.at("type") == "translate" && action.contains("profile")) {
      const Json& profile = action.at("profile");
      leg.has_profile = true;
      leg.start = profile.at("start");
      leg.cruise = profile.at("cruise");
      leg.end = profile.at("end");
      if (load.acceleration > 0.0) leg.rise = (leg.cruise - leg.start) / load.acceleration;
      if (load.deceleration > 0.0) leg.fall = (leg.cruise - leg.end) / load.deceleration;
    }
    legs_.push_back(leg);
    if (action.at("type") != "wait") rests_since_ = leg.t_end;
    rest(to, leg.t_end);
  }

  /// It is at rest in the pose until then, since `rests_since_`.
  void rest(const Json& pose, double until) {
    constexpr double kRounding = 1e-9;
    while (served_ < served_before_last_ && own_serves(pose, goals_[served_])) {
      const Json& goal = goals_[served_];
      const double end = std::max(rests_since_, goal.value("not_before", 0.0)) + goal.value("service", 0.0);
      if (end > until + kRounding) return;
      rests_since_ = end;
      loads_.push_back({end, loads_.back().load.after(goal)});
      ++served_;
    }
  }

  Json goals_;
  std::size_t served_before_last_ = 0;  // so many goals can be served on the way
  std::size_t served_ = 0;
  double rests_since_ = 0.0;
  double x_ = 0.0, y_ = 0.0;  // the start
  std::vector<Step> loads_;
  std::vector<Leg> legs_;
  std::size_t now_ = 0;
};

}  // namespace fleetplan::api
