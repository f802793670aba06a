// Requests with members of all kinds that are damaged at one place, wherever it is, to every endpoint. Each
// is served, or refused with its faults.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/motion_requests.h"
#include "tests/support/sanitized.h"

namespace fleetplan::api {
namespace TEST_FILE {

using Pointer = Json::json_pointer;
using Endpoint = Reply (*)(std::string_view, const RequestContext&);

/// A request with nearly every member that requests to plan may have.
Json fleet() {
  return Json::parse(R"({
    "map": {"rows": ["............", "............", ".....##.....", "............", "............"],
            "resolution": 1.0, "origin": {"x": 1.0, "y": 2.0}},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0, "vicinity": 0.1,
                       "stop_distance": 0.2, "may_reverse": true, "execution_margin": 0.01, "body_radius": 0.28},
    "robots": [
      {"id": "choosy", "start": {"x": 1.5, "y": 2.5, "theta": 0.0}, "idle": "yield",
       "goals": [{"any_of": [{"x": 11.5, "y": 2.5, "bias": 1.0}, {"x": 11.5, "y": 3.5, "theta": 0.0}], "service": 2.0,
                  "not_before": 1.0, "due": 30.0, "radius_after": 0.35, "actions": [{"type": "pick"}],
                  "metadata": {"task": 7}}],
       "metadata": {"make": "x"}},
      {"id": "heavy", "start": {"x": 1.5, "y": 6.5, "theta": 0.0}, "linear_acceleration": 0.5,
       "linear_deceleration": 0.5, "angular_acceleration": 2.0, "goal_age": 3.0, "weight": 2.0,
       "goals": [{"x": 6.5, "y": 6.5, "linear_speed_after": 0.5, "linear_acceleration_after": 0.25,
                  "linear_deceleration_after": 0.5}, {"x": 11.5, "y": 6.5, "theta": 1.0}]},
      {"id": "returning", "start": {"x": 4.5, "y": 3.5, "theta": 0.0}, "idle": "return",
       "goal": {"any_of": [{"x": 10.5, "y": 3.5}, {"x": 10.5, "y": 5.5}]}}],
    "zones": [
      {"id": "closed", "type": "blocked", "enter": false, "robots": ["heavy"],
       "polygon": [{"x": 12.0, "y": 2.0}, {"x": 13.0, "y": 2.0}, {"x": 13.0, "y": 3.0}]},
      {"id": "slow", "type": "speed", "linear_speed": 0.5, "angular_speed": 1.0,
       "polygon": [{"x": 5.0, "y": 2.0}, {"x": 6.0, "y": 2.0}, {"x": 6.0, "y": 7.0}]},
      {"id": "lane", "type": "one_way", "heading": 0.0, "half_angle": 1.6,
       "polygon": [{"x": 8.0, "y": 2.0}, {"x": 9.0, "y": 2.0}, {"x": 9.0, "y": 3.0}]}],
    "obstacles": [{"id": "person", "radius": 0.2, "after": "leaves",
                   "motion": [{"t": 0.0, "x": 7.5, "y": 2.2}, {"t": 3.0, "x": 7.5, "y": 6.5}]}],
    "options": {"time_budget_ms": 1000, "seed": 1, "max_iterations": 5, "dependencies": true, "dependency_slack": 0.5,
                "wait_before_move": 0.1, "inflation": 0.01, "start_safe_interval": 1.0, "horizon": 60.0, "mode": "anytime",
                "objective": "flowtime", "priority": "longest_first", "reordering": "raise_failed", "any_angle": true,
                "connectivity": 8, "replan": "all", "interval_margin": 0.0, "start_overlap": 0.0, "goal_overlap": 0.0,
                "invalid_robots": "report", "lattice_spacing": null, "execution_margin": 0.01},
    "metadata": {"list": [1, "two"]}})");
}

/// Requests about one fleet to all endpoints.
std::vector<std::pair<Endpoint, Json>> requests_about(const Json& request) {
  const Json answer = plan_of(request);
  Json merged = request;
  merged.update(answer);
  const Json state = Json::parse(R"([{"robot": "choosy", "action": 0, "progress": 0.5}])");
  const Json retiming{{"robots", request["robots"]},
                      {"robot_defaults", request["robot_defaults"]},
                      {"plans", answer["plans"]},
                      {"dependencies", answer["dependencies"]},
                      {"at", 1.0},
                      {"states", state}};
  Json simulation = merged;
  simulation.update(Json::parse(R"({"policy": "dependencies", "runs": 2, "seed": 3, "trace": 1,
    "disturbance": {"speed": {"min": 0.9, "max": 1.1}, "turn": {"min": 0.9, "max": 1.0},
                    "start_delay": {"min": 0.0, "max": 1.0}, "stops": {"rate_per_hour": 60.0, "mean_s": 2.0},
                    "cross_track": {"sigma": 0.01, "correlation_length": 1.0}}})"));
  const Json moment{
      {"request", request},
      {"plans", answer["plans"]},
      {"at", 2.0},
      {"commit", 1.0},
      {"pose_tolerance", 0.5},
      {"states", state},
      {"holds", Json::array({{{"robot", "heavy"}, {"until", 5.0}}})},
      {"goals", Json::array({{{"robot", "returning"}, {"goals", request["robots"][0]["goals"]}}})}};
  Json in_motion = answer_of(advance_endpoint, moment);
  const Json robot = Json::parse(R"({"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0})");
  const Json matrix{{"map", request["map"]},
                    {"zones", request["zones"]},
                    {"robot", robot},
                    {"from", Json::array({pose(1.5, 2.5)})},
                    {"to", Json::array({pose(11.5, 3.5), {{"x", 4.5}, {"y", 3.5}}})}};
  Json tasks{{"request", request}, {"tasks", Json::array()}};
  tasks["request"].erase("zones");
  for (Json& one : tasks["request"]["robots"]) {
    for (const char* member : {"goal", "goals", "idle"}) one.erase(member);
  }
  tasks["tasks"].push_back(
      {{"id", "t"}, {"goals", {{{"x", 11.5}, {"y", 3.5}}}}, {"robots", {"choosy", "heavy"}}});
  Json orders = retiming;
  orders.erase("at");
  orders.erase("states");
  orders.update(
      Json::parse(R"({"timestamp": "2026-11-27T10:00:00.00Z", "version": "2.1.0", "manufacturer": "m",
    "manufacturers": {"heavy": "n"}, "serial_numbers": {"choosy": "s1"}, "map_id": "floor",
    "map_ids": {"heavy": "ground"}, "release_ahead": 5.0})"));
  orders["map"] = request["map"];
  Json reports = orders;
  reports["progress"] = Json::array();
  const Json exported = answer_of(vda5050_endpoint, orders);
  for (const Json& order : exported["orders"]) {
    reports["progress"].push_back({{"robot", order["robot"]},
                                   {"order_id", order["order"]["orderId"]},
                                   {"order_update_id", order["order"]["orderUpdateId"]},
                                   {"last_released_sequence_id", order["last_released_sequence_id"]},
                                   {"action", 0},
                                   {"progress", 0.0}});
  }
  reports["messages"] = Json::parse(R"([{"serialNumber": "s1", "orderId": "", "orderUpdateId": 0,
    "lastNodeId": "n", "lastNodeSequenceId": 0, "driving": false, "nodeStates": [], "actionStates": [], "errors": [],
    "velocity": {"vx": 0.1, "omega": 0.0},
    "agvPosition": {"x": 1.6, "y": 2.5, "theta": 0.0, "mapId": "floor", "positionInitialized": true}}])");
  reports["messages"][0]["orderId"] = reports["progress"][0]["order_id"];
  return {{plan_endpoint, request},        {plan_endpoint, in_motion},        {validate_endpoint, merged},
          {dependencies_endpoint, merged}, {simulate_endpoint, simulation},   {advance_endpoint, moment},
          {retime_endpoint, retiming},     {matrix_endpoint, matrix},         {assign_endpoint, tasks},
          {vda5050_endpoint, orders},      {import_vda5050_endpoint, reports}};
}

/// Every place in the document.
void add_places(const Json& value, const Pointer& at, std::vector<Pointer>& places) {
  places.push_back(at);
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) add_places(member, at / key, places);
  }
  // Items of long lists are alike.
  for (std::size_t k = 0; value.is_array() && k < std::min<std::size_t>(value.size(), 3); ++k) {
    add_places(value[k], at / k, places);
  }
}

void remove(Json& document, Pointer at) {
  const std::string last = at.back();
  at.pop_back();
  Json& parent = document[at];
  if (parent.is_object()) {
    parent.erase(last);
  } else {
    parent.erase(std::stoul(last));
  }
}

/// The bodies with what is at this place left out or repeated, and with other values there.
std::vector<std::string> damaged(const Json& request, const Pointer& at) {
  const std::string mark = R"("what is damaged")";
  Json copy = request;
  Json& place = copy[at];
  const Json value = std::exchange(place, Json::parse(mark));
  const std::string text = copy.dump();
  const std::size_t begin = text.find(mark);
  std::vector<std::string> all;
  for (const char* other : {"null", "-1", "1e300", R"("x")", "[]", "{}", "[{}]"}) {
    all.push_back(text.substr(0, begin) + other + text.substr(begin + mark.size()));
  }
  if (value.is_array() && !value.empty()) {
    place = value;
    place.push_back(value.front());
    all.push_back(copy.dump());
  }
  if (at.empty()) return all;
  remove(copy, at);
  all.push_back(copy.dump());
  return all;
}

/// 200 with JSON, or 422 with faults or a budget that is spent.
void expect_proper(const Reply& reply, const std::string& request) {
  const Json answer = Json::parse(reply.body, nullptr, false);
  ASSERT_FALSE(answer.is_discarded()) << reply.body;
  if (reply.status == 200) return;
  ASSERT_EQ(reply.status, 422) << reply.body << "\nto " << request;
  const std::string code = answer.at("code");
  const bool is_spent = code == "check_unfinished" || code == "parse_unfinished" || code == "memory_exceeded";
  EXPECT_EQ(answer.at("errors").empty(), is_spent) << reply.body << "\nto " << request;
}

TEST(DamagedRequests, AreServedOrRefusedByAllEndpointsWhereverTheDamageIs) {
  std::map<int, int> counts;
  int tried = 0;
  for (const auto& [endpoint, request] : requests_about(fleet())) {
    ASSERT_EQ(endpoint(request.dump(), {}).status, 200) << endpoint(request.dump(), {}).body << request;
    std::vector<Pointer> places;
    add_places(request, Pointer(), places);
    for (const Pointer& at : places) {
      if (support::kSanitized && ++tried % 3 != 0) continue;
      for (const std::string& body : damaged(request, at)) {
        SCOPED_TRACE(at.to_string());
        const Reply reply = endpoint(body, {});
        ++counts[reply.status];
        expect_proper(reply, body);
      }
    }
  }
  RecordProperty("served", counts[200]);
  RecordProperty("refused", counts[422]);
  const int least = support::kSanitized ? 300 : 1000;
  EXPECT_GT(counts[200], least);
  EXPECT_GT(counts[422], least);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
