#pragma once

// Small fleets that have to get past each other, with everything that a request may have.

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/api/support/life_requests.h"
#include "tests/api/support/requests.h"
#include "tests/support/random_problem.h"

namespace fleetplan::api {

using support::Dice;

/// A small map and robots on cells of one metre, whose radii are less than half of that.
class TightFleet {
 public:
  explicit TightFleet(Dice& dice) : dice_(dice), rows_(rows()) {
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      for (std::size_t column = 0; column < rows_[row].size(); ++column) {
        if (rows_[row][column] != '.') continue;
        cells_.push_back(
            {{"x", static_cast<double>(column) + 0.5}, {"y", static_cast<double>(rows_.size() - row) - 0.5}});
      }
    }
  }

  Json request() {
    Json json{{"map", {{"rows", rows_}}}, {"options", Json::object()}, {"robots", Json::array()}};
    std::vector<Json> starts = shuffled();
    std::vector<Json> ends = shuffled();
    const int most = static_cast<int>(cells_.size()) / 3;
    const auto count = static_cast<std::size_t>(2 + dice_.below(std::clamp(most - 1, 1, 6)));
    has_radii_ = dice_.chance(0.5);
    for (std::size_t k = 0; k < count; ++k) json["robots"].push_back(robot(k, starts[k], ends[k]));
    return json;
  }

  /// Goals on any cells, the last one at its own.
  Json goals(const Json& last) {
    Json goals = Json::array();
    for (int more = dice_.below(3); more > 0; --more) goals.push_back(with_service(cell()));
    goals.push_back(with_service(last));
    if (dice_.chance(0.3)) goals.back()["theta"] = 0.5 * std::numbers::pi * dice_.below(4);
    return goals;
  }

  Json cell() { return cells_[static_cast<std::size_t>(dice_.below(static_cast<int>(cells_.size())))]; }

 private:
  std::vector<std::string> rows() {
    const auto length = static_cast<std::size_t>(4 + dice_.below(8));
    std::string bays(length, '#');
    for (int k = 1 + dice_.below(2); k > 0; --k) {
      bays[static_cast<std::size_t>(dice_.below(static_cast<int>(length)))] = '.';
    }
    const std::string corridor(length, '.');
    switch (dice_.below(5)) {
      case 0:
        return {bays, corridor};
      case 1:
        return {bays, corridor, bays};
      case 2:
        return {corridor, corridor};
      case 3:
        return {corridor, bays, corridor};
      default:
        return {corridor.substr(0, 4), corridor.substr(0, 4), corridor.substr(0, 4), corridor.substr(0, 4)};
    }
  }

  std::vector<Json> shuffled() {
    std::vector<Json> cells = cells_;
    for (std::size_t k = cells.size(); k > 1; --k) {
      std::swap(cells[k - 1], cells[static_cast<std::size_t>(dice_.below(static_cast<int>(k)))]);
    }
    return cells;
  }

  Json robot(std::size_t number, Json start, const Json& end) {
    start["theta"] = 0.5 * std::numbers::pi * dice_.below(4);
    const double radius = has_radii_ ? 0.05 * (4 + dice_.below(6)) : 0.4;
    Json robot{{"id", "r" + std::to_string(number)},
               {"radius", radius},
               {"linear_speed", 0.5 + 0.25 * dice_.below(5)},
               {"angular_speed", 1.0 + dice_.below(4)},
               {"start", start}};
    if (dice_.chance(0.85)) robot["goals"] = goals(end);
    return robot;
  }

  Json with_service(Json goal) {
    if (dice_.chance(0.4)) goal["service"] = dice_.between(0.0, 4.0);
    if (dice_.chance(0.15)) goal["not_before"] = dice_.between(0.0, 20.0);
    return goal;
  }

  Dice& dice_;
  std::vector<std::string> rows_;
  std::vector<Json> cells_;
  bool has_radii_ = false;
};

/// Adds loads that fit everywhere in a tight fleet.
inline void add_tight_loads(Dice& dice, Json& goals, const Json& robot) {
  for (Json& goal : goals) {
    if (dice.chance(0.4)) goal["radius_after"] = 0.05 * (4 + dice.below(6));
    if (dice.chance(0.3)) goal["linear_speed_after"] = 0.3 + 0.3 * dice.below(5);
    if (!robot.contains("linear_acceleration")) continue;
    if (dice.chance(0.3)) goal["linear_acceleration_after"] = 0.2 + 0.4 * dice.below(5);
    if (dice.chance(0.2)) goal["linear_deceleration_after"] = 0.2 + 0.4 * dice.below(5);
  }
}

inline Json tight_zone(Dice& dice, TightFleet& fleet, const std::string& id) {
  const Json cell = fleet.cell();
  const double x = cell.at("x").get<double>() - 0.5;
  const double y = cell.at("y").get<double>() - 0.5;
  const double wide = 1.0 + dice.below(3);
  Json zone{{"id", id},
            {"polygon",
             {{{"x", x}, {"y", y}},
              {{"x", x + wide}, {"y", y}},
              {{"x", x + wide}, {"y", y + 1.0}},
              {{"x", x}, {"y", y + 1.0}}}}};
  const int kind = dice.below(4);
  if (kind == 0) {
    zone.update(Json{{"type", "blocked"}, {"enter", false}});
  } else if (kind == 1) {
    zone.update(
        Json{{"type", "one_way"}, {"heading", std::numbers::pi * dice.below(2)}, {"half_angle", 1.0}});
  } else {
    zone.update(Json{{"type", "speed"}, {"linear_speed", dice.between(0.1, 0.8)}});
    if (dice.chance(0.4)) zone["angular_speed"] = dice.between(0.3, 2.0);
  }
  return zone;
}

inline Json tight_obstacle(Dice& dice, TightFleet& fleet, const std::string& id) {
  Json obstacle{{"id", id}, {"radius", 0.1 + 0.1 * dice.below(3)}, {"motion", Json::array()}};
  double t = dice.between(0.0, 15.0);
  for (int k = 2 + dice.below(3); k > 0; --k) {
    Json place = fleet.cell();
    place["t"] = t;
    obstacle["motion"].push_back(place);
    t += dice.between(2.0, 12.0);
  }
  return obstacle;
}

inline void add_tight_options(Dice& dice, Json& options) {
  options["max_iterations"] = 5;
  if (dice.chance(0.3)) options["mode"] = "anytime";
  if (dice.chance(0.3)) options["inflation"] = dice.between(0.0, 0.05);
  if (dice.chance(0.3)) options["wait_before_move"] = dice.between(0.0, 1.0);
  if (dice.chance(0.3)) options["connectivity"] = 4 << dice.below(4);
  if (dice.chance(0.3)) options["any_angle"] = false;
  if (dice.chance(0.3)) options["smoothing"] = false;
  if (dice.chance(0.5)) options["replan"] = "where_needed";
  if (dice.chance(0.3)) options["horizon"] = dice.between(1.0, 20.0);
  if (dice.chance(0.3)) options["start_safe_interval"] = dice.between(0.0, 4.0);
  if (dice.chance(0.4)) options["priority"] = dice.chance(0.5) ? "longest_first" : "random";
}

/// A tight fleet with all kinds of members. It may be invalid.
inline Json full_request(Dice& dice, TightFleet& fleet) {
  Json json = fleet.request();
  add_tight_options(dice, json["options"]);
  for (int k = dice.chance(0.4) ? 1 + dice.below(2) : 0; k > 0; --k) {
    json["zones"].push_back(tight_zone(dice, fleet, "z" + std::to_string(k)));
  }
  for (int k = dice.chance(0.35) ? 1 + dice.below(2) : 0; k > 0; --k) {
    json["obstacles"].push_back(tight_obstacle(dice, fleet, "o" + std::to_string(k)));
  }
  json["map"]["resolution"] = 1.0;
  if (dice.chance(0.35)) add_accelerations(dice, json);
  if (dice.chance(0.3)) add_stop_distances(dice, json);
  const bool has_loads = dice.chance(0.5);
  const bool has_vicinity = dice.chance(0.35);
  const bool reverses = dice.chance(0.35);
  for (Json& robot : json["robots"]) {
    if (has_loads && robot.contains("goals")) add_tight_loads(dice, robot["goals"], robot);
    if (has_vicinity && dice.chance(0.6)) robot["vicinity"] = dice.between(0.0, 0.2);
    if (reverses && dice.chance(0.6)) robot["may_reverse"] = true;
  }
  if (dice.chance(0.4)) add_open_goals(dice, json);
  return json;
}

/// Adds what is not in the other random requests either.
inline void add_more(Dice& dice, Json& json) {
  static constexpr std::array kIdle{"stay", "yield", "return"};
  json["options"]["time_budget_ms"] = 100'000;
  if (dice.chance(0.25)) {
    json["options"]["lattice_spacing"] =
        json.at("map").at("resolution").get<double>() * (dice.chance(0.5) ? 0.5 : 1.0);
  }
  if (dice.chance(0.5)) {
    for (Json& robot : json["robots"]) {
      if (dice.chance(0.6)) robot["idle"] = kIdle[static_cast<std::size_t>(dice.below(3))];
    }
  }
  if (!dice.chance(0.3)) return;
  for (Json& robot : json["robots"]) {
    if (dice.chance(0.3)) robot["weight"] = dice.between(0.5, 3.0);
    for (Json* goal : goals_of(robot)) {
      if (dice.chance(0.4)) (*goal)["due"] = goal->value("not_before", 0.0) + dice.between(0.0, 30.0);
    }
  }
}

}  // namespace fleetplan::api
