#include "tests/fuzz/effort_members.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "tests/support/base64.h"

namespace fleetplan::fuzz {

namespace {

using Json = nlohmann::json;

/// Members that images of maps and masks have in common.
void add_parameters(Json& image, Choices& choices) {
  image["mode"] = choices.one_of(std::array{"trinary", "scale", "raw"});
  if (choices.yes()) image["release"] = choices.one_of(std::array{"humble", "jazzy"});
  if (choices.yes()) image["negate"] = true;
  if (choices.yes()) image.update({{"occupied_thresh", 1.0}, {"free_thresh", 0.0}});
}

/// The image of rows of cells. The choice may turn it upside down.
Json image_of(const Json& map, Choices& choices) {
  const Json& rows = map["rows"];
  const std::size_t columns = rows[0].get_ref<const std::string&>().size();
  const double resolution = map.value("resolution", 1.0);
  std::string pixels;
  for (const Json& row : rows) {
    for (const char cell : row.get_ref<const std::string&>()) pixels += cell == '#' ? '\x64' : '\0';
  }
  const std::string header = "P5 " + std::to_string(columns) + " " + std::to_string(rows.size()) + " 100\n";
  Json image{{"pgm", support::base64(header + pixels)}, {"resolution", resolution}, {"negate", true}};
  if (choices.yes()) {
    image["origin"] = {resolution * static_cast<double>(columns),
                       resolution * static_cast<double>(rows.size()), 3.14159};
  }
  return image;
}

/// A rotation and a translation from a start to a goal.
Json straight_way(const Json& start, const Json& goal, const Json& speeds) {
  const double dx = goal["x"].get<double>() - start["x"].get<double>();
  const double dy = goal["y"].get<double>() - start["y"].get<double>();
  const double heading = std::atan2(dy, dx);
  const double turned = std::abs(heading) / speeds["angular_speed"].get<double>();
  const double arrived = turned + std::hypot(dx, dy) / speeds["linear_speed"].get<double>();
  const Json at{{"x", start["x"]}, {"y", start["y"]}, {"theta", 0.0}};
  const Json ahead{{"x", start["x"]}, {"y", start["y"]}, {"theta", heading}};
  const Json end{{"x", goal["x"]}, {"y", goal["y"]}, {"theta", heading}};
  Json actions = Json::array();
  if (turned > 0.0) {
    actions.push_back({{"type", "rotate"}, {"t_start", 0.0}, {"t_end", turned}, {"from", at}, {"to", ahead}});
  }
  if (arrived > turned) {
    actions.push_back(
        {{"type", "translate"}, {"t_start", turned}, {"t_end", arrived}, {"from", ahead}, {"to", end}});
  }
  return actions;
}

/// A list with so many times the same.
Json copies(const Json& of, int count) {
  Json list = Json::array();
  for (; count > 0; --count) list.push_back(of);
  return list;
}

Json safety_of(Choices& choices) {
  return {{choices.one_of(std::array{"eStop", "activeEmergencyStop"}),
           choices.one_of(std::array{"NONE", "MANUAL", "AUTOACK"})},
          {"fieldViolation", choices.yes()}};
}

/// Errors that refuse the order, or a part of it.
Json errors_of(Choices& choices) {
  const Json of_order{{"referenceKey", "orderId"}, {"referenceValue", "o"}};
  const Json of_update{{"referenceKey", "orderUpdateId"}, {"referenceValue", "0"}};
  const Json error{{"errorLevel", choices.one_of(std::array{"WARNING", "FATAL", "CRITICAL"})},
                   {"errorType", choices.one_of(std::array{"x", "START_NODE_OUT_OF_RANGE", "orderError"})},
                   {"errorReferences", copies(choices.yes() ? of_update : of_order, choices.up_to(300))}};
  return copies(error, choices.up_to(300));
}

/// What a vehicle may say of itself besides where it is.
Json availability_of(Choices& choices) {
  Json members{{"lastNodeId", choices.yes() ? "" : "n"}};
  if (choices.yes()) members["operatingMode"] = choices.one_of(std::array{"AUTOMATIC", "MANUAL", "SERVICE"});
  if (choices.yes()) members["safetyState"] = safety_of(choices);
  if (choices.yes()) members["paused"] = true;
  if (choices.yes()) members["errors"] = errors_of(choices);
  if (choices.yes()) members["nodeStates"] = copies({{"sequenceId", 4}}, choices.up_to(3000));
  if (choices.yes()) members["edgeStates"] = Json::array();
  if (choices.yes())
    members["instantActionStates"] =
        copies({{"actionId", "c"}, {"actionStatus", "FAILED"}}, choices.up_to(300));
  return members;
}

}  // namespace

void add_files(Json& request, Choices& choices) {
  if (!choices.yes()) request["options"]["invalid_robots"] = "report";
  if (request.contains("zones")) {
    for (Json& zone : request["zones"]) {
      if (!zone.contains("mask") || !choices.yes()) continue;
      add_parameters(zone["mask"], choices);
      if (zone["type"] != "speed") continue;
      zone["mask"]["base"] = choices.one_of(std::array{100.0, 0.0, -1e6});
      zone["mask"]["multiplier"] = choices.one_of(std::array{-1.0, 1.0, 0.7, 1e6});
    }
  }
  if (!choices.yes()) return;
  Json image = image_of(request["map"], choices);
  if (choices.yes()) add_parameters(image, choices);
  request["map"] = {{"image", std::move(image)}, {"unknown", choices.one_of(std::array{"free", "blocked"})}};
}

void add_chosen_ways(Json& request, Choices& choices) {
  if (!choices.yes()) return;
  const auto chosen = static_cast<std::size_t>(choices.byte());
  const char* member = choices.one_of(std::array{"previous", "committed"});
  for (Json& robot : request["robots"]) {
    if (!robot.contains("goal") || !robot["goal"].contains("any_of")) continue;
    Json& goal = robot["goal"];
    const std::size_t choice = chosen % goal["any_of"].size();
    goal["choice"] = choice;
    goal["any_of"][0]["bias"] = static_cast<double>(chosen);
    robot[member] = straight_way(robot["start"], goal["any_of"][choice], request["robot_defaults"]);
  }
}

void add_vehicle_members(Json& body, Choices& choices) {
  if (!choices.yes()) return;
  const Json members = availability_of(choices);
  const bool is_elsewhere = choices.yes();
  const bool has_order = choices.yes();
  const bool is_cancelled = choices.yes();
  const bool serves = choices.yes();
  body["progress"] = Json::array();
  for (Json& message : body["messages"]) {
    message.update(members);
    if (is_elsewhere) message["agvPosition"].update({{"mapId", "another"}, {"positionInitialized", false}});
    Json progress{{"robot", message["serialNumber"]}, {"action", 0}, {"progress", 0.5}};
    if (serves) progress["served"] = 1;
    if (has_order)
      progress.update({{"order_id", "o"}, {"order_update_id", 0}, {"last_released_sequence_id", 4}});
    if (has_order && is_cancelled) progress["cancel_id"] = "c";
    if (!has_order && is_cancelled) progress["ended_order_id"] = "o";
    body["progress"].push_back(std::move(progress));
  }
}

}  // namespace fleetplan::fuzz
