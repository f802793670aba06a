#pragma once

// The first requests of random lives of fleets, with all kinds of members.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/model/problem.h"
#include "tests/api/support/fleet_json.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {

inline std::vector<core::Zone> zones_for(support::Dice& dice, const core::Problem& problem) {
  using Type = core::Zone::Type;
  std::vector<core::Zone> zones =
      support::random_zones(dice, problem, {Type::blocked, Type::one_way, Type::speed});
  for (core::Zone& zone : zones) {  // a request has a limit in each, and shares in masks only
    zone.linear_speed_share = core::Zone::kNoLimit;
    const bool has_any = std::min(zone.linear_speed, zone.angular_speed) < core::Zone::kNoLimit;
    if (zone.type == Type::speed && !has_any) zone.angular_speed = 1.0;
    if (zone.type == Type::blocked) zone.may_leave = dice.chance(0.5);
  }
  return zones;
}

/// Many robots on a small open field that pass each other as near as their inflation allows.
inline support::FleetRequest crowd(support::Dice& dice) {
  const core::OccupancyGrid grid(8 + dice.below(6), 8 + dice.below(6), 1.0);
  support::FleetRequest request{grid, support::random_robots(dice, grid, 12), {}, {}};
  for (core::Robot& robot : request.robots) robot.radius = std::min(robot.radius, 0.6);
  request.options.inflation = dice.between(0.02, 0.2);
  return request;
}

/// Robots that need some way to stop; most of them need a short way.
inline void add_stop_distances(support::Dice& dice, Json& json) {
  const double resolution = json.at("map").at("resolution").get<double>();
  for (Json& robot : json.at("robots")) {
    if (dice.chance(0.7))
      robot["stop_distance"] = resolution * dice.between(0.0, dice.chance(0.3) ? 4.0 : 1.0);
  }
}

/// The goals of a robot, however they are given.
inline std::vector<Json*> goals_of(Json& robot) {
  std::vector<Json*> goals;
  if (robot.contains("goal")) goals.push_back(&robot["goal"]);
  if (!robot.contains("goals")) return goals;
  for (Json& goal : robot["goals"]) goals.push_back(&goal);
  return goals;
}

/// Robots that need time to start and to stop; some loads change that.
inline void add_accelerations(support::Dice& dice, Json& json) {
  for (Json& robot : json.at("robots")) {
    const double speed = robot.at("linear_speed").get<double>();
    const auto acceleration = [&] { return speed * std::pow(10.0, dice.between(-1.0, 1.0)); };
    if (dice.chance(0.7)) {
      robot["linear_acceleration"] = acceleration();
      if (dice.chance(0.5)) robot["linear_deceleration"] = acceleration();
      const bool has_loads = dice.chance(0.4);
      for (Json* goal : goals_of(robot)) {
        if (has_loads && dice.chance(0.5)) (*goal)["linear_acceleration_after"] = acceleration();
        if (has_loads && dice.chance(0.3)) (*goal)["linear_deceleration_after"] = acceleration();
      }
    }
    if (dice.chance(0.5)) robot["angular_acceleration"] = std::pow(10.0, dice.between(-1.0, 2.0));
  }
}

/// Some goals may be served where others have goals, too. Robots that stay at their last goals can do so at
/// their own goals.
inline void add_open_goals(support::Dice& dice, Json& json) {
  std::vector<Json> places;
  for (Json& robot : json.at("robots")) {
    for (const Json* goal : goals_of(robot)) {
      Json& place = places.emplace_back();
      for (const char* member : {"x", "y", "theta"}) {
        if (goal->contains(member)) place[member] = goal->at(member);
      }
    }
  }
  std::size_t own = 0;
  for (Json& robot : json.at("robots")) {
    for (Json* goal : goals_of(robot)) {
      const Json place = places[own++];
      if (dice.chance(0.4)) {
        if (dice.chance(0.5)) (*goal)["tolerance"] = dice.between(0.0, 1.0);
        continue;
      }
      Json poses = Json::array({place});
      for (int more = 1 + dice.below(4); more > 0; --more) {
        poses.push_back(places[static_cast<std::size_t>(dice.below(static_cast<int>(places.size())))]);
        if (dice.chance(0.3)) poses.back()["bias"] = dice.between(0.0, 20.0);
      }
      std::swap(poses.front(), poses[static_cast<std::size_t>(dice.below(static_cast<int>(poses.size())))]);
      for (const char* member : {"x", "y", "theta"}) goal->erase(member);
      (*goal)["any_of"] = std::move(poses);
    }
  }
}

/// A valid request with all kinds of members.
inline Json first_request(support::Dice& dice) {
  while (true) {
    support::FleetRequest request = dice.chance(0.4) ? crowd(dice) : support::random_request(dice);
    if (dice.chance(0.5)) support::add_loads(dice, request);
    if (dice.chance(0.3)) support::push_goals_into_walls(dice, request);
    const auto plain = support::problem_of(request);
    if (!plain) continue;
    if (dice.chance(0.4)) request.zones = zones_for(dice, *plain);
    if (dice.chance(0.3)) request.options.horizon = dice.between(1.0, 30.0);
    if (!support::problem_of(request)) continue;
    Json json = json_of(request);
    json["options"]["time_budget_ms"] = 100'000;
    if (dice.chance(0.3)) json["options"]["invalid_robots"] = "report";
    if (dice.chance(0.2)) json["options"]["dependencies"] = true;
    if (dice.chance(0.3)) add_stop_distances(dice, json);
    if (dice.chance(0.3)) add_accelerations(dice, json);
    if (dice.chance(0.4)) add_open_goals(dice, json);
    return json;
  }
}

}  // namespace fleetplan::api
