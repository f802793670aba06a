// What reports say of orders, by the standard of VDA 5050 2.0, 2.1 and 3.0.0:
//
// - which vehicle has refused or lost an order,
// - whose report opens gates,
// - what is not served,
// - and what a vehicle cannot do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/vda5050/reporting.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;

struct Refusal {
  const char* error;
  const char* order_id;  // that the vehicle reports; "=": the order it was sent
  bool is_refused;
};

const std::vector<Refusal> kRefusals{
    // By reference to the order and its update, whatever the type is.
    {R"({"errorType": "orderError", "refs": {"orderId": "=", "orderUpdateId": "0"}})", "", true},
    {R"({"errorType": "x", "refs": {"orderId": "=", "orderUpdateId": "0"}})", "", true},
    {R"({"errorType": "x", "refs": {"orderId": "=", "orderUpdateId": 0}})", "", true},
    // By reference to the order alone.
    {R"({"errorType": "START_NODE_OUT_OF_RANGE", "refs": {"orderId": "="}})", "", true},
    {R"({"errorType": "OTHER_ORDER_ACTIVE", "refs": {"orderId": "="}})", "another", true},
    {R"({"errorType": "NO_ROUTE_TO_TARGET", "refs": {"orderId": "="}})", "", true},
    {R"({"errorType": "MOBILE_ROBOT_NOT_AVAILABLE", "refs": {"orderId": "="}})", "", true},
    {R"({"errorType": "UNKNOWN_MAP_ID", "refs": {"orderId": "="}})", "", true},
    {R"({"errorType": "noRouteError", "refs": {"orderId": "="}})", "", true},
    {R"({"errorType": "of the maker", "refs": {"orderId": "="}})", "", true},
    {R"({"refs": {"orderId": "="}})", "", true},
    // Without one, but of a type that says so.
    {R"({"errorType": "validationError"})", "", true},
    {R"({"errorType": "VALIDATION_FAILURE", "refs": {"topic": "order"}})", "", true},
    {R"({"errorType": "INVALID_ORDER_ACTION", "refs": {"actionId": "7"}})", "", true},
    {R"({"errorType": "orderUpdateError", "refs": {"orderUpdateId": "0"}})", "", true},
    // Of another order, of another update, or of none.
    {R"({"errorType": "orderError", "refs": {"orderId": "another", "orderUpdateId": "0"}})", "", false},
    {R"({"errorType": "START_NODE_OUT_OF_RANGE", "refs": {"orderId": "another"}})", "", false},
    {R"({"errorType": "orderUpdateError", "refs": {"orderId": "=", "orderUpdateId": "7"}})", "=", false},
    {R"({"errorType": "orderUpdateError", "refs": {"orderUpdateId": "7"}})", "", false},
    {R"({"errorType": "dirtyScanner"})", "", false},
    // Of an order that it has accepted.
    {R"({"errorType": "pickError", "refs": {"orderId": "=", "actionId": "7"}})", "=", false},
    {R"({"errorType": "START_NODE_OUT_OF_RANGE", "refs": {"orderId": "="}})", "=", false},
    {R"({"errorType": "validationError"})", "=", false},
};

/// An error with references by key; "=" stands for the order that was sent.
Json error_of(const char* text, const std::string& order_id) {
  Json error = Json::parse(text);
  error["errorLevel"] = "WARNING";
  const Json references = error.value("refs", Json::object());
  for (const auto& item : references.items()) {
    const Json& value = item.value();
    error["errorReferences"].push_back(
        {{"referenceKey", item.key()}, {"referenceValue", value == "=" ? Json(order_id) : value}});
  }
  error.erase("refs");
  return error;
}

TEST(Order, ThatIsRefusedHasFailed) {
  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(std::string(refusal.error) + " " + refusal.order_id);
    Reporting hall;
    const std::string sent = hall.messages[0]["orderId"];
    hall.messages[0]["orderId"] = refusal.order_id == std::string("=") ? sent : refusal.order_id;
    hall.messages[0]["errors"] = Json::array({error_of(refusal.error, sent)});
    const Json vehicle = hall.imported(hall.messages)["vehicles"][0];
    EXPECT_EQ(vehicle["failed"].get<bool>(), refusal.is_refused);
    EXPECT_EQ(testing::Matches(testing::Contains("order_refused"))(reasons_of(vehicle)), refusal.is_refused);
  }
}

TEST(Order, WhoseUpdateIsRefusedHasFailed) {
  Reporting hall;
  hall.body["progress"][0]["order_update_id"] = 3;
  const std::string sent = hall.messages[0]["orderId"];
  hall.messages[0]["orderUpdateId"] = 2;
  const auto has_failed = [&](const char* error) {
    hall.messages[0]["errors"] = Json::array({error_of(error, sent)});
    return hall.imported(hall.messages)["vehicles"][0]["failed"].get<bool>();
  };
  EXPECT_TRUE(has_failed(R"({"errorType": "NO_ROUTE_TO_TARGET", "refs": {"orderId": "="}})"));
  EXPECT_TRUE(has_failed(R"({"errorType": "orderUpdateError"})"));
  EXPECT_TRUE(has_failed(R"({"errorType": "x", "refs": {"orderId": "=", "orderUpdateId": "3"}})"));
  EXPECT_FALSE(has_failed(
      R"({"errorType": "OUTDATED_ORDER_UPDATE", "refs": {"orderId": "=", "orderUpdateId": "1"}})"));
  EXPECT_FALSE(has_failed(R"({"errorType": "slippery", "refs": {"orderId": "="}})")) << "it is under way";
}

struct Told {
  const char* patch;
  Strings reasons;
};

const std::vector<Told> kTold{
    {R"({})", {}},
    {R"({"operatingMode": "SEMIAUTOMATIC"})", {}},
    {R"({"operatingMode": "MANUAL"})", {"operating_mode"}},
    {R"({"operatingMode": "SERVICE"})", {"operating_mode"}},
    {R"({"operatingMode": "TEACHIN"})", {"operating_mode"}},
    {R"({"operatingMode": "TEACH_IN"})", {"operating_mode"}},
    {R"({"operatingMode": "STARTUP"})", {"operating_mode"}},
    {R"({"operatingMode": "INTERVENED"})", {"operating_mode"}},
    {R"({"operatingMode": "HOVERING"})", {"operating_mode"}},
    {R"({"operatingMode": "MANUAL", "nodeStates": [], "edgeStates": []})",
     {"operating_mode", "order_cleared"}},
    {R"({"nodeStates": [], "edgeStates": [], "driving": false})", {"order_cleared"}},
    {R"({"nodeStates": [], "edgeStates": [], "driving": true})", {}},
    {R"({"safetyState": {"eStop": "AUTOACK"}})", {"emergency_stop"}},
    {R"({"safetyState": {"activeEmergencyStop": "REMOTE"}})", {"emergency_stop"}},
    {R"({"safetyState": {"fieldViolation": true}})", {"field_violation"}},
    {R"({"paused": true})", {"paused"}},
    {R"({"agvPosition": {"positionInitialized": false}})", {"not_localized"}},
    {R"({"agvPosition": {"positionInitialized": null, "localized": false, "x": "NaN"}})", {"not_localized"}},
    {R"({"agvPosition": {"mapId": "attic"}})", {"other_map"}},
    {R"({"agvPosition": null, "mobileRobotPosition": {"mapId": "attic"}})", {"other_map"}},
    {R"({"errors": [{"errorLevel": "FATAL", "errorType": "motor"}]})", {"error"}},
    {R"({"errors": [{"errorLevel": "CRITICAL"}]})", {"error"}},
    {R"({"errors": [{"errorLevel": "URGENT"}, {"errorLevel": "WARNING"}]})", {}},
    {R"({"orderId": "", "nodeStates": []})", {"order_unknown"}},
    {R"({"orderId": "another"})", {"other_order"}},
    {R"({"orderUpdateId": 5})", {"other_order"}},
    {R"({"actionStates": [{"actionId": "x", "actionStatus": "RETRIABLE"}]})", {"action_retriable"}},
    {R"({"operatingMode": "SERVICE", "lastNodeId": "", "lastNodeSequenceId": 12, "nodeStates": [],
         "safetyState": {"eStop": "MANUAL", "fieldViolation": true}, "paused": true})",
     {"operating_mode", "emergency_stop", "field_violation", "paused", "order_cleared"}},
};

TEST(Availability, TellsWhatAVehicleCannotDo) {
  const Reporting hall;
  const Json usual = hall.imported(hall.messages);
  for (const Told& told : kTold) {
    SCOPED_TRACE(told.patch);
    const Json answer = hall.imported_with(Json::parse(told.patch));
    EXPECT_EQ(reasons_of(of_robot(answer["vehicles"], "a")), told.reasons);
    EXPECT_EQ(told_of(answer, "b"), told_of(usual, "b"));
  }
}

TEST(Availability, TellsThatAVehicleWasRestarted) {
  Reporting hall;
  hall.body["progress"][0]["progress"] = 0.2;
  const Json answer = hall.imported_with(
      Json::parse(R"({"orderId": "", "lastNodeId": "", "nodeStates": [], "edgeStates": []})"));
  EXPECT_THAT(reasons_of(answer["vehicles"][0]), ElementsAre("restarted"));
  const Json progress = of_robot(answer["progress"], "a");
  EXPECT_EQ(progress["ended_order_id"], hall.messages[0]["orderId"]);
  EXPECT_FALSE(progress.contains("order_id"));
  const Json state = of_robot(answer["states"], "a");
  EXPECT_FALSE(state.contains("released"));
  EXPECT_EQ(state["x"], 4.0) << "the next plan begins where it stands";
  hall.body["progress"] = answer["progress"];
  EXPECT_TRUE(hall.exported()["orders"].empty()) << "and no order of this plan does";
}

TEST(Availability, TellsOfOrdersOfOtherSenders) {
  Reporting hall;
  hall.body.erase("progress");
  EXPECT_THAT(reasons_of(hall.imported(hall.messages)["vehicles"][0]), ElementsAre("other_order"));
  hall.messages[0]["nodeStates"] = Json::array();
  EXPECT_TRUE(reasons_of(hall.imported(hall.messages)["vehicles"][0]).empty()) << "it has finished that one";
}

/// Whether "a" may pass "b" when this has been reported of it.
bool opens(Reporting hall, const Json& message) {
  hall.body["progress"] = hall.imported({hall.messages[0], message})["progress"];
  return !hall.exported()["orders"].empty();
}

TEST(Gates, AreOpenedByReportsThatCountOnly) {
  const Reporting hall;
  const Json arrived = at_end(hall);
  EXPECT_TRUE(opens(hall, arrived));
  for (const char* patch :
       {R"({"operatingMode": "SEMIAUTOMATIC"})", R"({"operatingMode": null})", R"({"agvPosition": null})",
        R"({"paused": true})", R"({"safetyState": {"eStop": "MANUAL"}})"}) {
    EXPECT_TRUE(opens(hall, patched(arrived, Json::parse(patch)))) << patch;
  }
  for (const char* patch :
       {R"({"orderId": "another"})", R"({"orderId": ""})", R"({"orderUpdateId": 1})", R"({"lastNodeId": ""})",
        R"({"lastNodeId": null})", R"({"agvPosition": {"positionInitialized": false}})",
        R"({"agvPosition": {"localized": false}})", R"({"agvPosition": {"mapId": "attic"}})",
        R"({"operatingMode": "SERVICE", "lastNodeId": ""})", R"({"nodeStates": [{"sequenceId": 4}]})",
        R"({"agvPosition": {"x": 1e10}})", R"({"lastNodeSequenceId": 6})", R"({"lastNodeSequenceId": 3})"}) {
    EXPECT_FALSE(opens(hall, patched(arrived, Json::parse(patch)))) << patch;
  }
}

TEST(Gates, AreOpenedByAnOrderThatWasFinished) {
  const Reporting hall;
  // A vehicle at its goal is there, whoever controls it. A vehicle that was moved away is not.
  for (const char* mode : {"MANUAL", "INTERVENED"}) {
    Json message = at_end(hall);
    message["operatingMode"] = mode;
    EXPECT_TRUE(opens(hall, message)) << mode;
    message["agvPosition"]["y"] = 5.0;
    EXPECT_FALSE(opens(hall, message)) << mode;
  }
}

TEST(Gates, ThatWereOpenedStayOpen) {
  for (const Told& told : kTold) {
    SCOPED_TRACE(told.patch);
    Reporting hall;
    const Json first = hall.imported({hall.messages[0], at_end(hall)});
    hall.body["progress"] = first["progress"];
    const Json odd = patched(hall.messages[1], Json::parse(told.patch));
    EXPECT_TRUE(opens(hall, odd));
    EXPECT_EQ(of_robot(hall.imported(Json::array({odd}))["progress"], "b")["action"],
              of_robot(first["progress"], "b")["action"]);
  }
}

/// The hall, where "a" has come to its pick, and may drive on.
struct Picking : Reporting {
  Picking() {
    body["progress"] = imported({messages[0], at_end(*this)})["progress"];
    const Json sent = exported()["orders"][0];
    body["progress"][0] = progress_of(sent);
    order = sent["order"];
    messages[0] = with_everything(state_message(order, 4, 10.0, 5.0));
    messages[0]["nodeStates"] = Json::parse(R"([{"sequenceId": 6, "released": true}])");
  }
  /// Reports a status of the action at the pick.
  Json with_status(const char* status) {
    for (const Json& node : order["nodes"]) {
      for (const Json& action : node["actions"]) id = action["actionId"];
    }
    messages[0]["actionStates"] = {{{"actionId", id}, {"actionStatus", status}}};
    return imported(messages);
  }
  Json order;
  std::string id;
};

TEST(Action, ThatHasFailedIsNotServed) {
  Picking hall;
  const Json served = hall.with_status("FINISHED");
  EXPECT_EQ(served["states"][0]["action"], 1);
  EXPECT_TRUE(served["vehicles"][0]["failed_actions"].empty());

  const Json failed = hall.with_status("FAILED");
  EXPECT_EQ(failed["states"][0]["action"], 0) << "it is at its goal";
  EXPECT_EQ(failed["states"][0]["progress"], 1.0);
  const Json vehicle = failed["vehicles"][0];
  EXPECT_TRUE(vehicle["failed"].get<bool>());
  EXPECT_THAT(reasons_of(vehicle), ElementsAre("action_failed"));
  EXPECT_EQ(vehicle["failed_actions"], Json::array({Json{{"action_id", hall.id}, {"goal", 0}}}));

  // A vehicle that waits for another try has not ended it.
  const Json retriable = hall.with_status("RETRIABLE");
  EXPECT_EQ(retriable["states"][0]["action"], 0);
  EXPECT_THAT(reasons_of(retriable["vehicles"][0]), ElementsAre("action_retriable"));
}

TEST(Action, ThatHasFailedIsPlannedAgainWithoutTheOrder) {
  Picking hall;
  hall.with_status("FAILED");
  // It has driven on: gates behind it open, but its goal is kept.
  hall.messages[0]["lastNodeSequenceId"] = 6;
  hall.messages[0]["nodeStates"] = Json::array();
  hall.messages[0]["agvPosition"]["x"] = 18.0;
  const Json beyond = hall.imported(hall.messages);
  EXPECT_GT(of_robot(beyond["progress"], "a")["action"], 1);
  EXPECT_EQ(beyond["states"][0]["action"], 0);
  EXPECT_FALSE(beyond["states"][0].contains("x"));
  EXPECT_FALSE(beyond["vehicles"][0]["arrived"].get<bool>());
  hall.body["progress"] = beyond["progress"];
  hall.body["progress"][0]["cancel_id"] = "stop";
  hall.messages[0]["instantActionStates"] = {{{"actionId", "stop"}, {"actionStatus", "FAILED"}}};
  const Json ended = hall.imported(hall.messages);
  EXPECT_EQ(ended["states"][0]["x"], 18.0);
  EXPECT_FALSE(ended["vehicles"][0]["failed"].get<bool>());
  const std::size_t goals = hall.request["robots"][0]["goals"].size();
  hall.advance(9.0, ended["states"]);
  EXPECT_EQ(hall.request["robots"][0]["goals"].size(), goals);
}

/// States that open no gates.
const std::vector<const char*> kUncounted{R"({"operatingMode": "MANUAL"})",
                                          R"({"agvPosition": {"positionInitialized": false}})",
                                          R"({"agvPosition": {"mapId": "attic"}})"};

TEST(Action, ThatIsFinishedIsServedWhereverItsVehicleIs) {
  for (const char* patch : kUncounted) {
    SCOPED_TRACE(patch);
    Picking hall;
    hall.messages[0].merge_patch(Json::parse(patch));
    const Json before = of_robot(hall.with_status("RUNNING")["progress"], "a");
    EXPECT_FALSE(before.contains("served"));
    Json after = hall.with_status("FINISHED");
    EXPECT_EQ(after["states"][0]["action"], 1) << "behind the service";
    EXPECT_EQ(after["states"][0]["progress"], 1.0);
    Json progress = of_robot(after["progress"], "a");
    EXPECT_EQ(progress["served"], 1);
    progress.erase("served");
    EXPECT_EQ(progress, before) << "it opens no gates";
    // The vehicle is restarted, and knows nothing of it any more.
    hall.body["progress"] = after["progress"];
    hall.body["base"] = Json::array({{{"robot", "a"}, {"order", hall.order}, {"state", hall.messages[0]}}});
    hall.messages[0]["orderId"] = "";
    hall.messages[0]["nodeStates"] = hall.messages[0]["actionStates"] = Json::array();
    after = hall.imported(hall.messages);
    EXPECT_EQ(of_robot(after["progress"], "a")["served"], 1);
    EXPECT_EQ(after["states"][0]["action"], 1);
  }
}

TEST(Action, ThatIsFinishedAsItsOrderEndsIsServed) {
  Picking hall;
  hall.body["progress"][0]["cancel_id"] = "stop";
  hall.messages[0]["instantActionStates"] = {{{"actionId", "stop"}, {"actionStatus", "FINISHED"}}};
  EXPECT_EQ(hall.with_status("FAILED")["states"][0]["action"], 0);
  const Json answer = hall.with_status("FINISHED");
  EXPECT_EQ(of_robot(answer["progress"], "a")["ended_order_id"], hall.order["orderId"]);
  EXPECT_EQ(answer["states"][0]["action"], 1);
  hall.advance(9.0, answer["states"]);
  EXPECT_EQ(hall.request["robots"][0]["goals"].size(), 1U);
}

TEST(Action, OfABaseThatIsFinishedIsServed) {
  Picking hall;
  hall.advance(9.0, hall.with_status("RUNNING")["states"]);
  ASSERT_EQ(hall.request["robots"][0]["goals"].size(), 2U);
  hall.body["progress"] = Json::array();
  hall.body["base"] = Json::array({{{"robot", "a"}, {"order", hall.order}, {"state", hall.messages[0]}}});
  hall.messages[0]["agvPosition"]["mapId"] = "attic";
  EXPECT_FALSE(of_robot(hall.with_status("RUNNING")["progress"], "a").contains("served"));
  EXPECT_FALSE(of_robot(hall.with_status("FAILED")["progress"], "a").contains("served"));
  const Json answer = hall.with_status("FINISHED");
  EXPECT_EQ(of_robot(answer["progress"], "a")["served"], 1);
  hall.advance(1.0, answer["states"]);
  EXPECT_EQ(hall.request["robots"][0]["goals"].size(), 1U);
}

TEST(Cancellation, EndsWithAnOrderThatIsNotThere) {
  Reporting hall;
  hall.body["progress"][0]["cancel_id"] = "stop";
  const auto has_order = [&](const char* patch) {
    return of_robot(hall.imported_with(Json::parse(patch))["progress"], "a").contains("order_id");
  };
  EXPECT_TRUE(has_order(R"({})"));
  EXPECT_FALSE(has_order(R"({"actionStates": [{"actionId": "stop", "actionStatus": "FINISHED"}]})"));
  EXPECT_TRUE(has_order(R"({"instantActionStates": [{"actionId": "stop", "actionStatus": "FAILED"}]})"))
      << "it still has nodes to reach";
  EXPECT_FALSE(has_order(
      R"({"nodeStates": [], "instantActionStates": [{"actionId": "stop", "actionStatus": "FAILED"}]})"));
  for (const char* type : {"noOrderToCancel", "NO_ORDER_TO_CANCEL"}) {
    Json patch = Json::parse(R"({"nodeStates": null, "errors": [{"errorLevel": "WARNING",
      "errorReferences": [{"referenceKey": "actionId", "referenceValue": "stop"}]}]})");
    patch["errors"][0]["errorType"] = type;
    EXPECT_FALSE(has_order(patch.dump().c_str())) << type;
    patch["errors"][0]["errorReferences"][0]["referenceValue"] = "another";
    EXPECT_TRUE(has_order(patch.dump().c_str())) << type;
  }
}

/// Whether a value has null somewhere.
bool has_null(const Json& value) {
  if (!value.is_structured()) return value.is_null();
  return std::any_of(value.begin(), value.end(), has_null);
}

TEST(Export, HasWhatTheVersionHas) {
  Hall hall;
  hall.body["allowed_deviation"] = 0.05;
  hall.request["robots"][0]["goals"][0]["actions"] = Json::parse(R"([
    {"type": "pick", "blocking_type": "SINGLE", "retriable": true,
     "parameters": {"none": null, "side": {"left": null, "right": 1}, "list": [1, null, [null]]}},
    {"type": "beep", "blocking_type": "SOFT"}])");
  hall.plan = answer_of(plan_endpoint, hall.request);
  for (const char* version : {"2.1.0", "3.0.0"}) {
    hall.body["version"] = version;
    const bool is_v3 = version[0] == '3';
    const Json answer = hall.exported();
    EXPECT_FALSE(has_null(answer));
    const Json& node = answer["orders"][0]["order"]["nodes"][2];
    const Json& pick = node["actions"][0];
    EXPECT_EQ(pick["blockingType"], is_v3 ? "SINGLE" : "HARD");
    EXPECT_EQ(pick.contains("retriable"), is_v3);
    EXPECT_FALSE(node["actions"][1].contains("retriable"));
    EXPECT_EQ(node["actions"][1]["blockingType"], "SOFT");
    EXPECT_EQ(pick["actionParameters"].dump(),
              R"([{"key":"side","value":{"right":1}},{"key":"list","value":[1,[]]}])");
    const Json round = Json::parse(R"({"a": 0.05, "b": 0.05, "theta": 0.0})");
    EXPECT_EQ(node["nodePosition"]["allowedDeviationXY"], is_v3 ? round : Json(0.05));
  }
  hall.body.erase("allowed_deviation");
  EXPECT_FALSE(
      hall.exported()["orders"][0]["order"]["nodes"][2]["nodePosition"].contains("allowedDeviationXY"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
