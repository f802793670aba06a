#pragma once

// The hall, with vehicles that report everything, and what answers say of vehicles.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/api/vda5050/hall.h"

namespace fleetplan::api {

using Strings = std::vector<std::string>;

/// A value of a list in an answer, by robot.
inline Json of_robot(const Json& list, const std::string& robot) {
  for (const Json& entry : list) {
    if (entry["robot"] == robot) return entry;
  }
  return {};
}

inline Strings reasons_of(const Json& vehicle) {
  Strings reasons;
  for (const Json& reason : vehicle["availability"]["reasons"]) reasons.push_back(reason["reason"]);
  EXPECT_EQ(vehicle["availability"]["available"].get<bool>(), reasons.empty());
  return reasons;
}

inline Strings faults_of_vehicle(const Json& vehicle) {
  Strings faults;
  for (const Json& fault : vehicle["errors"]) {
    faults.push_back(fault["pointer"].get<std::string>() + " " + fault["code"].get<std::string>());
  }
  EXPECT_EQ(vehicle["errors_total"], faults.size());
  return faults;
}

/// What an answer says of a robot.
inline Json told_of(const Json& answer, const std::string& robot) {
  Json told;
  for (const char* list : {"states", "poses", "progress", "vehicles"})
    told[list] = of_robot(answer[list], robot);
  return told;
}

/// A message as a vehicle of 3.0.0 sends it.
inline Json with_everything(Json message) {
  message["headerId"] = 7;
  message["timestamp"] = "2026-11-23T12:00:03.000Z";
  message["operatingMode"] = "AUTOMATIC";
  message["driving"] = true;
  message["paused"] = false;
  message["nodeStates"] = Json::parse(R"([{"nodeId": "n", "sequenceId": 2, "released": true}])");
  message["edgeStates"] = Json::parse(R"([{"edgeId": "e", "sequenceId": 1, "released": true}])");
  message["safetyState"] = {{"eStop", "NONE"}, {"fieldViolation", false}};
  message["instantActionStates"] = Json::array();
  return message;
}

/// The hall, where "a" and "b" report everything.
struct Reporting : Moving {
  Reporting() {
    for (Json& message : messages) message = with_everything(message);
  }
  Json imported_with(const Json& patch) const {
    Json patched = messages;
    patched[0].merge_patch(patch);
    return imported(patched);
  }
};

/// A patch cannot make a member null, so "null" stands for it.
inline Json patched(Json message, const Json& patch) {
  message.merge_patch(patch);
  for (Json& member : message) {
    if (member == "null") member = nullptr;
  }
  return message;
}

/// The message of "b" that has come to its end, which opens the gate of "a".
inline Json at_end(const Reporting& hall) {
  Json message = hall.messages[1];
  message.merge_patch(
      Json::parse(R"({"lastNodeSequenceId": 4, "nodeStates": [], "edgeStates": [], "driving": false,
                                      "agvPosition": {"y": 9.0}})"));
  return message;
}

}  // namespace fleetplan::api
