#pragma once

// Two vehicles whose ways cross in a hall, for tests of orders that are released and continued.

#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {

/// Robot "a" picks something up on its way through a hall, and "b" crosses before it.
inline Json crossing_request() {
  Json request = Json::parse(R"({
    "map": {"rows": [], "resolution": 0.5},
    "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.0},
    "robots": [
      {"id": "a", "start": {"x": 1, "y": 5},
       "goals": [{"x": 10, "y": 5, "service": 5, "metadata": {"action": "pick"}}, {"x": 18, "y": 5}]},
      {"id": "b", "start": {"x": 9, "y": 1, "theta": 1.57}, "goal": {"x": 9, "y": 9}}],
    "options": {"dependencies": true, "interval_margin": 0.5}})");
  request["map"]["rows"] = Json(20, std::string(40, '.'));
  return request;
}

/// A fleet from plan to plan.
struct Hall {
  Json request = crossing_request();
  Json plan = answer_of(plan_endpoint, request);
  Json body = {{"version", "2.1.0"},
               {"manufacturer", "acme"},
               {"timestamp", "2026-11-23T12:00:00.000Z"},
               {"map_id", "hall"}};

  Json exported() const { return answer_of(vda5050_endpoint, complete()); }
  Json import_of(const Json& messages) const {
    Json all = complete();
    all["messages"] = messages;
    return all;
  }
  Json imported(const Json& messages) const {
    return answer_of(import_vda5050_endpoint, import_of(messages));
  }
  Json complete() const {
    Json all = body;
    for (const char* member : {"robots", "robot_defaults", "options"}) all[member] = request[member];
    for (const char* member : {"plans", "dependencies"}) all[member] = plan[member];
    return all;
  }

  /// Plans for a later moment.
  void advance(double at, const Json& states, const Json& goals = Json::array()) {
    const Json next{{"request", request}, {"plans", plan["plans"]}, {"at", at},
                    {"commit", 1.0},      {"states", states},       {"goals", goals}};
    request = answer_of(advance_endpoint, next);
    plan = answer_of(plan_endpoint, request);
    EXPECT_EQ(plan["status"], "solved");
  }
};

/// The progress of a vehicle that has been sent an order and has not moved.
inline Json progress_of(const Json& sent) {
  return {{"robot", sent["robot"]},
          {"order_id", sent["order"]["orderId"]},
          {"order_update_id", sent["order"]["orderUpdateId"]},
          {"last_released_sequence_id", sent["last_released_sequence_id"]},
          {"action", 0},
          {"progress", 0}};
}

inline Json state_message(const Json& order, int node, double x, double y) {
  return {
      {"serialNumber", order["serialNumber"]},
      {"orderId", order["orderId"]},
      {"orderUpdateId", order["orderUpdateId"]},
      {"lastNodeId", order["nodes"][0]["nodeId"]},
      {"lastNodeSequenceId", node},
      {"agvPosition", {{"x", x}, {"y", y}, {"theta", 0.0}, {"mapId", "hall"}, {"positionInitialized", true}}},
      {"actionStates", Json::array()},
      {"errors", Json::array()}};
}

/// After three seconds: "a" is at x = 4, and may drive to x = 8.19, where it waits for "b".
struct Moving : Hall {
  Json first = exported()["orders"];
  Json messages = {state_message(first[0]["order"], 0, 4.0, 5.0),
                   state_message(first[1]["order"], 0, 9.0, 3.9)};
  Json base = {{{"robot", "a"}, {"order", first[0]["order"]}, {"state", messages[0]}},
               {{"robot", "b"}, {"order", first[1]["order"]}, {"state", messages[1]}}};

  Moving() { body["progress"] = {progress_of(first[0]), progress_of(first[1])}; }

  /// Begins with the next plan.
  void begin() {
    body.erase("progress");
    body["base"] = base;
  }
};

}  // namespace fleetplan::api
