#pragma once

// Random fleets as requests of POST /v1/plan.

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tests/api/support/requests.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/random_zones.h"

namespace fleetplan::api {

inline Json json_of(const core::Position& position) { return {{"x", position.x()}, {"y", position.y()}}; }

inline Json json_of(const core::Pose& pose) {
  Json json = json_of(pose.position);
  json["theta"] = pose.theta;
  return json;
}

inline Json json_of(const core::Goal& goal) {
  Json json = json_of(goal.position);
  if (goal.theta) json["theta"] = *goal.theta;
  if (goal.service > 0.0) json["service"] = goal.service;
  if (goal.not_before > 0.0) json["not_before"] = goal.not_before;
  if (goal.radius_after) json["radius_after"] = *goal.radius_after;
  if (goal.linear_speed_after) json["linear_speed_after"] = *goal.linear_speed_after;
  if (goal.linear_acceleration_after) json["linear_acceleration_after"] = *goal.linear_acceleration_after;
  if (goal.linear_deceleration_after) json["linear_deceleration_after"] = *goal.linear_deceleration_after;
  return json;
}

/// A robot before anything is planned for it.
inline Json json_of(const core::Robot& robot) {
  Json json{{"id", robot.id},
            {"radius", robot.radius},
            {"linear_speed", robot.linear_speed},
            {"angular_speed", robot.angular_speed},
            {"vicinity", robot.vicinity},
            {"may_reverse", robot.may_reverse},
            {"start", json_of(robot.start)}};
  if (!robot.goal) return json;
  for (const core::Goal& goal : robot.via) json["goals"].push_back(json_of(goal));
  json["goals"].push_back(json_of(*robot.goal));
  return json;
}

inline Json json_of(const core::MovingObstacle& obstacle) {
  Json json{{"id", obstacle.id}, {"radius", obstacle.radius}, {"motion", Json::array()}};
  json["after"] = obstacle.after == core::MovingObstacle::After::stays ? "stays" : "leaves";
  for (const auto& entry : obstacle.motion) {
    Json place = json_of(entry.position);
    place["t"] = entry.t;
    json["motion"].push_back(std::move(place));
  }
  return json;
}

inline Json json_of(const core::Zone& zone, const std::vector<core::Robot>& robots) {
  static constexpr std::array kTypes{"blocked", "one_way", "speed"};
  using Type = core::Zone::Type;
  const int type = zone.type == Type::blocked ? 0 : zone.type == Type::one_way ? 1 : 2;
  Json json{{"id", zone.id}, {"type", kTypes[static_cast<std::size_t>(type)]}, {"polygon", Json::array()}};
  for (const core::Position& corner : zone.polygon) json["polygon"].push_back(json_of(corner));
  if (zone.linear_speed < core::Zone::kNoLimit) json["linear_speed"] = zone.linear_speed;
  if (zone.angular_speed < core::Zone::kNoLimit) json["angular_speed"] = zone.angular_speed;
  if (zone.may_leave) json["enter"] = false;
  if (zone.type == Type::one_way) json["heading"] = zone.heading, json["half_angle"] = zone.half_angle;
  for (const std::size_t robot : zone.robots) json["robots"].push_back(robots[robot].id);
  return json;
}

inline Json json_of(const core::PlanOptions& options) {
  using Options = core::PlanOptions;
  static constexpr std::array kPriorities{"shortest_first", "longest_first", "as_listed", "random"};
  static constexpr std::array kReorderings{"raise_failed", "random", "none"};
  Json json{{"mode", options.mode == Options::Mode::anytime ? "anytime" : "first"},
            {"objective", options.objective == Options::Objective::makespan ? "makespan" : "flowtime"},
            {"replan", options.replan == Options::Replan::where_needed ? "where_needed" : "all"},
            {"priority", kPriorities[static_cast<std::size_t>(options.priority)]},
            {"reordering", kReorderings[static_cast<std::size_t>(options.reordering)]},
            {"seed", options.seed},
            {"any_angle", options.any_angle},
            {"smoothing", options.smoothing},
            {"connectivity", options.connectivity},
            {"start_safe_interval", options.start_safe_interval},
            {"inflation", options.inflation},
            {"wait_before_move", options.wait_before_move},
            {"interval_margin", options.interval_margin},
            {"start_overlap", options.start_overlap},
            {"goal_overlap", options.goal_overlap}};
  if (options.max_iterations) json["max_iterations"] = *options.max_iterations;
  if (options.horizon) json["horizon"] = *options.horizon;
  return json;
}

inline Json json_of(const core::OccupancyGrid& grid) {
  Json rows = Json::array();
  for (int row = grid.rows(); row-- > 0;) {  // the top one first
    std::string cells;
    for (int column = 0; column < grid.columns(); ++column) {
      cells += grid.blocked({column, row}) ? '#' : '.';
    }
    rows.push_back(cells);
  }
  return {{"rows", rows}, {"resolution", grid.resolution()}};
}

inline Json json_of(const support::FleetRequest& request) {
  Json json{{"map", json_of(request.grid)}, {"options", json_of(request.options)}};
  for (const core::Robot& robot : request.robots) json["robots"].push_back(json_of(robot));
  for (const core::MovingObstacle& obstacle : request.obstacles)
    json["obstacles"].push_back(json_of(obstacle));
  for (const core::Zone& zone : request.zones) json["zones"].push_back(json_of(zone, request.robots));
  return json;
}

}  // namespace fleetplan::api
