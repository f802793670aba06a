// Orders of vehicles that drive while the fleet is planned again. They are continued from their released
// part, or cancelled. What vehicles report becomes states of robots.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"
#include "tests/api/vda5050/hall.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

Faults faults_of_import(const Json& body) {
  const Reply reply = import_vda5050_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 422) << reply.body;
  return faults_in(reply);
}

TEST(LiveOrders, AreContinuedFromTheLastReleasedNode) {
  Moving hall;
  const Json reported = hall.imported(hall.messages);
  EXPECT_NEAR(reported["states"][0]["progress"].get<double>(), 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(reported["states"][0]["released"]["progress"].get<double>(), 0.8, 0.002);
  hall.advance(3.0, reported["states"]);
  hall.begin();
  const Json update = hall.exported();
  EXPECT_TRUE(update["cancel_orders"].empty());
  EXPECT_TRUE(update["orders"].empty()) << "there is a gate behind what is released";
  EXPECT_TRUE(hall.imported(hall.messages)["vehicles"][0]["accepted"].get<bool>());

  // When "b" has passed, "a" may go on.
  hall.body["progress"] =
      hall.imported(Json::array({state_message(hall.first[1]["order"], 4, 9.0, 9.0)}))["progress"];
  const Json order = hall.exported()["orders"][0]["order"];
  const Json& last = hall.first[0]["order"]["nodes"][1];
  EXPECT_EQ(last["nodeId"], "a-2");
  EXPECT_EQ(order["orderId"], hall.first[0]["order"]["orderId"]);
  EXPECT_EQ(order["orderUpdateId"], 1);
  EXPECT_EQ(order["nodes"][0], last);
  EXPECT_EQ(order["nodes"][1]["sequenceId"], last["sequenceId"].get<int>() + 2);
  EXPECT_EQ(order["nodes"][1]["nodeId"], "a-1-4") << "not the node that the horizon has had";
  EXPECT_EQ(order["edges"][0]["startNodeId"], "a-2");
  EXPECT_TRUE(order["nodes"][1]["released"].get<bool>());
}

TEST(LiveOrders, AreCancelledIfThePlanTurnsOffBeforeTheEndOfTheirBase) {
  Moving hall;
  Json states = hall.imported(hall.messages)["states"];
  for (Json& state : states) state.erase("released");
  hall.advance(3.0, states);
  hall.begin();
  const Json answer = hall.exported();
  EXPECT_TRUE(answer["orders"].empty()) << "nobody goes on";
  EXPECT_FALSE(answer["all_released"].get<bool>());
  ASSERT_EQ(answer["cancel_orders"].size(), 2U);
  const Json& cancelled = answer["cancel_orders"][0];
  EXPECT_EQ(cancelled["robot"], "a");
  EXPECT_THAT(cancelled["detail"].get<std::string>(), HasSubstr("is at (8.19"));
  EXPECT_EQ(cancelled["instant_actions"]["serialNumber"], "a");
  EXPECT_EQ(cancelled["instant_actions"]["actions"][0].dump(),
            R"({"actionType":"cancelOrder","actionId":"a-2026-11-23T12:00:00.000Z-0-cancel",)"
            R"("blockingType":"NONE","actionParameters":[]})");
  hall.body["version"] = "3.0.0";
  const Json action = hall.exported()["cancel_orders"][0]["instant_actions"]["actions"][0];
  EXPECT_EQ(action["actionParameters"].size(), 1U);
  EXPECT_EQ(action["blockingType"], "NONE") << "the only one that 3.0.0 has for instant actions";
}

TEST(LiveOrders, AreCancelledIfTheirBaseHasAClosedGate) {
  Moving hall;
  hall.advance(3.0, hall.imported(hall.messages)["states"]);
  hall.begin();
  const Json gate = {{"robot", "a"}, {"action", 0}, {"progress", 0.5}};
  hall.plan["dependencies"] = {
      {{"gate", gate}, {"until", {{"robot", "b"}, {"action", 0}, {"progress", 0.1}}}}};
  EXPECT_THAT(hall.exported()["cancel_orders"][0]["detail"].get<std::string>(),
              HasSubstr("is behind a gate"));
}

TEST(LiveOrders, AreCancelledIfThePlanPassesOtherNodes) {
  Moving hall;
  hall.advance(3.0, hall.imported(hall.messages)["states"]);
  hall.begin();
  Json& nodes = hall.body["base"][0]["order"]["nodes"];
  Json beside = nodes[1];
  beside["nodePosition"]["y"] = 5.5;
  nodes.insert(nodes.begin() + 1, beside);
  EXPECT_THAT(hall.exported()["cancel_orders"][0]["detail"].get<std::string>(),
              HasSubstr("not committed to pass"));
  // A node that it has left behind does not matter.
  nodes[1]["sequenceId"] = 0;
  EXPECT_TRUE(hall.exported()["cancel_orders"].empty());
}

TEST(LiveOrders, EndWithNewGoalsFromTheEndOfTheirBaseOn) {
  Moving hall;
  hall.advance(3.0, hall.imported(hall.messages)["states"],
               Json::parse(R"([{"robot": "a", "goals": [{"x": 3, "y": 8}]}])"));
  hall.begin();
  const Json answer = hall.exported();
  EXPECT_TRUE(answer["cancel_orders"].empty());
  EXPECT_EQ(answer["orders"][0]["order"]["nodes"][0], hall.first[0]["order"]["nodes"][1]);
  EXPECT_EQ(answer["orders"][0]["order"]["nodes"].back()["nodePosition"]["x"], 3.0);
}

TEST(LiveOrders, OfVehiclesThatAreBeingCancelledGetNoUpdate) {
  Moving hall;
  hall.body["progress"][0]["cancel_id"] = "stop";
  hall.body["progress"][1]["progress"] = 1.0;
  hall.body["progress"][1]["action"] = 1;
  EXPECT_TRUE(hall.exported()["orders"].empty());
  Json stopping = hall.imported(hall.messages);
  EXPECT_EQ(stopping["progress"][0]["cancel_id"], "stop");
  EXPECT_TRUE(stopping["states"][0].contains("released"));
  hall.messages[0]["actionStates"] = {{{"actionId", "stop"}, {"actionStatus", "FINISHED"}}};
  const Json stopped = hall.imported(hall.messages);
  EXPECT_FALSE(stopped["progress"][0].contains("order_id"));
  EXPECT_FALSE(stopped["states"][0].contains("released"));
  EXPECT_EQ(stopped["states"][0]["x"], 4.0);
  EXPECT_EQ(stopped["states"][0]["theta"], 0.0);
}

TEST(LiveOrders, HaveTheMapOfTheirVehicle) {
  Hall hall;
  hall.body["map_ids"] = {{"b", "floor 1"}};
  const Json answer = hall.exported();
  EXPECT_EQ(answer["orders"][0]["order"]["nodes"][0]["nodePosition"]["mapId"], "hall");
  EXPECT_EQ(answer["orders"][1]["order"]["nodes"][0]["nodePosition"]["mapId"], "floor 1");
}

TEST(LiveOrders, OfSeveralMakesMayHaveTheSameSerialNumbers) {
  Moving hall;
  hall.body["manufacturers"] = {{"b", "bolt"}};
  hall.body["serial_numbers"] = {{"a", "1"}, {"b", "1"}};
  for (Json& message : hall.messages) {
    message["manufacturer"] = message["serialNumber"] == "b" ? Json("bolt") : hall.body["manufacturer"];
    message["serialNumber"] = "1";
  }
  const Json states = hall.imported(hall.messages);
  Moving plain;
  EXPECT_EQ(states, plain.imported(plain.messages));

  hall.messages[0].erase("manufacturer");
  hall.messages[1]["manufacturer"] = "nobody";
  const Json answer = hall.imported(hall.messages);
  ASSERT_EQ(answer["errors"].size(), 2U);
  EXPECT_EQ(answer["errors"][0]["pointer"], "/messages/0/manufacturer");
  EXPECT_EQ(answer["errors"][1]["pointer"], "/messages/1/manufacturer");
  EXPECT_EQ(answer["errors"][1]["code"], "unknown_robot");
}

TEST(LiveOrders, AreReleasedSoManySecondsAhead) {
  Hall hall;
  hall.body["release_ahead"] = 2.0;
  const Json sent = hall.exported()["orders"];
  EXPECT_EQ(sent[0]["last_released_sequence_id"], 4);
  EXPECT_NEAR(sent[0]["order"]["nodes"][2]["nodePosition"]["x"].get<double>(), 3.0, 1e-6);
  hall.body["progress"] = Json::array({progress_of(sent[0])});
  hall.body["progress"][0]["progress"] = 0.2;
  EXPECT_EQ(hall.exported()["orders"][0]["order"]["nodes"][0]["sequenceId"], 4);
}

TEST(LiveOrders, OfLongPlansNeedALongerTimeAhead) {
  Hall hall;
  hall.request["robot_defaults"]["linear_speed"] = 1e-3;
  hall.plan = answer_of(plan_endpoint, hall.request);
  hall.body["release_ahead"] = 0.1;
  Json body = hall.complete();
  body["messages"] = Json::array();
  EXPECT_EQ(faults_of_import(body), (Faults{{"/release_ahead", "out_of_range"}}));
}

TEST(LiveOrders, HaveTheActionsOfGoals) {
  Hall hall;
  Json& goal = hall.request["robots"][0]["goals"][0];
  goal["actions"] = Json::parse(R"([{"type": "pick", "parameters": {"loadType": "EPAL", "sides": [1, 2]}},
                                    {"type": "beep", "blocking_type": "SOFT"}])");
  hall.plan = answer_of(plan_endpoint, hall.request);
  EXPECT_EQ(hall.plan["plans"][0]["visits"][0]["actions"], goal["actions"]);
  const Json order = hall.exported()["orders"][0]["order"];
  const Json& actions = order["nodes"][2]["actions"];
  ASSERT_EQ(actions.size(), 2U);
  EXPECT_EQ(actions[0]["actionType"], "pick");
  EXPECT_EQ(actions[0]["blockingType"], "HARD");
  EXPECT_EQ(actions[0]["actionParameters"].dump(),
            R"([{"key":"loadType","value":"EPAL"},{"key":"sides","value":[1,2]}])");
  EXPECT_EQ(actions[1]["blockingType"], "SOFT");
  EXPECT_NE(actions[0]["actionId"], actions[1]["actionId"]);

  // They are executed in the order in which the vehicle does them, and the service is over with the last one.
  hall.body["progress"] = Json::array({progress_of(hall.exported()["orders"][0])});
  hall.body["progress"][0]["last_released_sequence_id"] = 4;
  Json message = state_message(order, 4, 10.0, 5.0);
  message["actionStates"] = {{{"actionId", actions[0]["actionId"]}, {"actionStatus", "FINISHED"}},
                             {{"actionId", actions[1]["actionId"]}, {"actionStatus", "RUNNING"}}};
  const Json busy = hall.imported(Json::array({message}))["states"][0];
  EXPECT_EQ(busy["action"], 0);
  EXPECT_EQ(busy["progress"], 1.0);
  EXPECT_EQ(busy["released"].dump(), R"({"action":1,"progress":1.0})");
  message["actionStates"][1]["actionStatus"] = "FINISHED";
  EXPECT_EQ(hall.imported(Json::array({message}))["states"][0]["action"], 1);

  const Json later{{"request", hall.request}, {"plans", hall.plan["plans"]}, {"at", 2.0}};
  EXPECT_EQ(answer_of(advance_endpoint, later)["robots"][0]["goals"][0]["actions"], goal["actions"]);
  goal.erase("service");
  EXPECT_EQ(brief_faults_of(hall.request), (Faults{{"/robots/0/goals/0/service", "missing"}}));
  goal["service"] = 0;
  EXPECT_EQ(brief_faults_of(hall.request), (Faults{{"/robots/0/goals/0/service", "out_of_range"}}));
  goal["service"] = 1;
  goal["actions"] = Json::parse(R"([{"blocking_type": "NO", "parameters": 7, "scope": "node"}])");
  EXPECT_EQ(brief_faults_of(hall.request),
            (Faults{{"/robots/0/goals/0/actions/0/blocking_type", "unknown_value"},
                    {"/robots/0/goals/0/actions/0/parameters", "wrong_type"},
                    {"/robots/0/goals/0/actions/0/scope", "unknown_key"},
                    {"/robots/0/goals/0/actions/0/type", "missing"}}));
  goal["actions"] = {{{"type", "pick"}, {"parameters", {{"text", std::string(20'000, 'x')}}}}};
  EXPECT_EQ(brief_faults_of(hall.request), (Faults{{"/robots/0/goals/0/actions", "out_of_range"}}));
}

TEST(VehicleStates, OfMessagesOnTheirWayAreAsBefore) {
  Moving hall;
  hall.messages[0]["orderId"] = "an earlier one";
  const Json state = hall.imported(hall.messages)["states"][0];
  EXPECT_EQ(state["progress"], 0.0);
  EXPECT_NEAR(state["released"]["progress"].get<double>(), 0.8, 0.002);
}

TEST(VehicleStates, HaveNotReachedWhatTheyHaveStillToReach) {
  Moving hall;
  hall.messages[1]["lastNodeSequenceId"] = 4;  // of the order before
  hall.messages[1]["nodeStates"] = Json::parse(R"([{"sequenceId": 0, "released": true}, {"sequenceId": 2}])");
  const Json told = hall.imported(hall.messages);
  EXPECT_FALSE(told["vehicles"][1]["arrived"].get<bool>());
  EXPECT_EQ(told["states"][1]["action"], 0);
  EXPECT_EQ(told["states"][1]["progress"], 0.0);
}

TEST(VehicleStates, NeverGoBack) {
  Moving hall;
  hall.body["progress"][0]["progress"] = 0.5;
  EXPECT_EQ(hall.imported(hall.messages)["states"][0]["progress"], 0.5);
}

TEST(LiveOrders, HaveToBeReadable) {
  Moving hall;
  Json body = hall.complete();
  EXPECT_EQ(faults_of_import(body), (Faults{{"/messages", "missing"}}));
  body["messages"] = 7;
  EXPECT_EQ(faults_of_import(body), (Faults{{"/messages", "wrong_type"}}));
  body["messages"] = Json::array();
  body["base"] = Json::parse(R"([{"robot": "a", "order": {"orderId": "", "orderUpdateId": 0, "nodes": []}},
    {"robot": "b", "order": {"orderId": "x", "orderUpdateId": 0, "nodes": [
      {"nodeId": "n", "sequenceId": 0, "released": false, "nodePosition": {"x": 0, "y": 0}}]}}])");
  EXPECT_EQ(faults_of_import(body),
            (Faults{{"/base/0/order/orderId", "empty"}, {"/base/1/order/nodes", "out_of_range"}}));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
