#include "tests/bench/lifelong/fleet_request.h"

#include <algorithm>
#include <string>
#include <utility>

namespace fleetplan::bench {
namespace {

using core::Action;
using nlohmann::json;

json pose_json(const core::Pose& pose) {
  return {{"x", pose.position.x()}, {"y", pose.position.y()}, {"theta", pose.theta}};
}

core::Pose pose_of(const json& pose) {
  return {core::Position(pose.at("x").get<double>(), pose.at("y").get<double>()),
          pose.at("theta").get<double>()};
}

const char* name_of(Action::Type type) {
  if (type == Action::Type::rotate) return "rotate";
  return type == Action::Type::translate ? "translate" : "wait";
}

Action::Type type_of(const std::string& name) {
  if (name == "rotate") return Action::Type::rotate;
  return name == "translate" ? Action::Type::translate : Action::Type::wait;
}

json actions_json(const Actions& actions) {
  json list = json::array();
  for (const Action& action : actions) {
    list.push_back({{"type", name_of(action.type)},
                    {"t_start", action.t_start},
                    {"t_end", action.t_end},
                    {"from", pose_json(action.from)},
                    {"to", pose_json(action.to)}});
  }
  return list;
}

json robot_json(const Vehicle& vehicle, const core::Pose& start) {
  return {{"id", vehicle.id},
          {"radius", vehicle.type.radius},
          {"linear_speed", vehicle.type.linear_speed},
          {"angular_speed", vehicle.type.angular_speed},
          {"start", pose_json(start)}};
}

json snapshot_of(const Vehicle& vehicle, double now, const LifelongJob& job) {
  json robot = robot_json(vehicle, vehicle.pose(now));
  if (!in_service(vehicle, now, job.service)) robot["goal"] = pose_json(vehicle.goal);
  return robot;
}

/// A robot that is free, or without a plan, or has a new goal waits until the commitment ends.
json committed_of(const Vehicle& vehicle, double now, const LifelongJob& job) {
  const core::Pose start = vehicle.pose(now);
  json robot = robot_json(vehicle, start);
  const Actions ahead = shifted(cut(vehicle.actions, now).after, -now);
  const bool goes_on = vehicle.free_at != Vehicle::kNever && vehicle.free_at > now;
  const Actions committed = waiting_until(cut(ahead, job.commit).before, job.commit, 0.0, start);
  robot["committed"] = actions_json(committed);
  json goal = pose_json(vehicle.goal);
  goal["service"] = in_service(vehicle, now, job.service) ? vehicle.free_at - now : job.service;
  robot["goals"] = json::array({std::move(goal)});
  if (goes_on) {
    Actions previous = committed;
    const Actions rest = cut(ahead, job.commit).after;
    previous.insert(previous.end(), rest.begin(), rest.end());
    robot["previous"] = actions_json(previous);
  }
  return robot;
}

}  // namespace

json fleet_request(const json& map, const Fleet& fleet, double now, const LifelongJob& job) {
  json robots = json::array();
  for (const Vehicle& vehicle : fleet.vehicles()) {
    robots.push_back(job.strategy == Strategy::committed ? committed_of(vehicle, now, job)
                                                         : snapshot_of(vehicle, now, job));
  }
  return {{"map", map}, {"robots", std::move(robots)}};
}

json lone_request(const json& map, const Vehicle& vehicle, const core::Pose& from) {
  json robot = robot_json(vehicle, from);
  robot["goal"] = pose_json(vehicle.goal);
  return {{"map", map}, {"robots", json::array({std::move(robot)})}};
}

json map_json(const core::OccupancyGrid& grid) {
  json rows = json::array();
  for (int row = grid.rows() - 1; row >= 0; --row) {
    std::string cells;
    for (int column = 0; column < grid.columns(); ++column) cells += grid.blocked({column, row}) ? '#' : '.';
    rows.push_back(std::move(cells));
  }
  return {{"rows", std::move(rows)}, {"resolution", grid.resolution()}};
}

Actions actions_of(const json& list) {
  Actions actions;
  for (const json& action : list) {
    actions.push_back({type_of(action.at("type")),
                       action.at("t_start"),
                       action.at("t_end"),
                       pose_of(action.at("from")),
                       pose_of(action.at("to")),
                       {}});
  }
  return actions;
}

}  // namespace fleetplan::bench
