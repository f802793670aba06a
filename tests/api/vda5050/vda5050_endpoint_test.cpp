#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/fault_case.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

/// The export of a plan of the request that can be executed at any pace.
Json exported(Json request) {
  request["options"] = {{"interval_margin", 0.5}, {"inflation", 0.01}, {"dependencies", true}};
  const Reply reply = plan_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  const Json answer = json_of(reply);
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_TRUE(answer["tight"].empty());
  Json body = {{"version", "2.1.0"},
               {"manufacturer", "acme"},
               {"timestamp", "2026-01-31T12:00:00.000Z"},
               {"map_id", "hall"},
               {"map", request["map"]},
               {"robots", request["robots"]},
               {"plans", answer["plans"]},
               {"dependencies", answer["dependencies"]}};
  if (request.contains("robot_defaults")) body["robot_defaults"] = request["robot_defaults"];
  return body;
}

Json orders(const Json& body) {
  const Reply reply = vda5050_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

Faults faults_of_export(const Json& body) {
  const Reply reply = vda5050_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 422);
  return faults_in(reply);
}

/// The rules that the schema of an order does not have.
void expect_order(const Json& order) {
  const Json& nodes = order["nodes"];
  const Json& edges = order["edges"];
  ASSERT_EQ(edges.size() + 1, nodes.size());
  ASSERT_TRUE(nodes[0]["released"].get<bool>());
  const int first = nodes[0]["sequenceId"];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const int offset = 2 * static_cast<int>(k);
    EXPECT_EQ(nodes[k]["sequenceId"], first + offset);
    if (k == 0) continue;
    const Json& edge = edges[k - 1];
    EXPECT_EQ(edge["sequenceId"], first + offset - 1);
    if (order["version"] == "2.1.0") {
      EXPECT_EQ(edge["startNodeId"], nodes[k - 1]["nodeId"]);
      EXPECT_EQ(edge["endNodeId"], nodes[k]["nodeId"]);
    }
    EXPECT_EQ(edge["released"], nodes[k]["released"]);
    EXPECT_TRUE(nodes[k - 1]["released"].get<bool>() || !nodes[k]["released"].get<bool>());
  }
}

TEST(Vda5050, GivesEachRobotThatMovesAnOrder) {
  Json body = exported(swap_request());
  body["serial_numbers"] = {{"b", "0815"}};
  body["manufacturers"] = {{"b", "bolt"}};
  const Json answer = orders(body);
  ASSERT_EQ(answer["orders"].size(), 2U);
  EXPECT_EQ(answer["orders"][0]["order"]["manufacturer"], body["manufacturer"]);
  EXPECT_EQ(answer["orders"][1]["order"]["manufacturer"], "bolt");
  const Json& order = answer["orders"][1]["order"];
  EXPECT_EQ(order["version"], "2.1.0");
  EXPECT_EQ(order["serialNumber"], "0815");
  EXPECT_EQ(order["orderUpdateId"], 0);
  EXPECT_EQ(order["nodes"][0]["nodePosition"].dump(), R"({"x":8.5,"y":1.5,"theta":3.0,"mapId":"hall"})");
  EXPECT_EQ(order["nodes"].back()["nodePosition"]["theta"], 0.25);
  for (const Json& each : answer["orders"]) expect_order(each["order"]);

  body["robots"].push_back({{"id", "parked"}, {"start", {{"x", 4.5}, {"y", 3.5}}}});
  EXPECT_EQ(orders(body)["orders"].size(), 2U);
}

TEST(Vda5050, ListsTheFirstOfManySerialNumbersOfUnknownRobots) {
  Json body = exported(swap_request());
  Json serials = {{"a", "0815"}};
  for (int k = 0; k < 5000; ++k) serials["unknown " + std::to_string(k)] = "x";
  body["serial_numbers"] = serials;
  const Reply reply = vda5050_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 422);
  const Json problem = json_of(reply);
  EXPECT_EQ(problem["errors_total"], 5000);
  EXPECT_EQ(problem["errors"].size(), 20U);
  EXPECT_EQ(problem["errors"][0]["detail"], "There is no robot \"unknown 0\" in robots.");
  body["serial_numbers"] = Json::array();
  EXPECT_EQ(faults_of_export(body), (Faults{{"/serial_numbers", "wrong_type"}}));
  body["serial_numbers"] = {{"a", 7}};
  EXPECT_EQ(faults_of_export(body), (Faults{{"/serial_numbers/a", "wrong_type"}}));
}

TEST(Vda5050, NamesMembersAsTheVersionDoes) {
  Json body = exported(swap_request());
  body["version"] = "3.0.0";
  const Json order = orders(body)["orders"][0]["order"];
  EXPECT_EQ(order["version"], "3.0.0");
  EXPECT_TRUE(order["edges"][0].contains("maximumSpeed"));
  EXPECT_FALSE(order["edges"][0].contains("startNodeId"));
  EXPECT_FALSE(order["edges"][0].contains("rotationAllowed"));
  expect_order(order);
}

/// The progress of a robot that has been sent this, and has reached the last node of its base.
Json at_end_of_base(const Json& sent) {
  const Json& last = sent["last_released_sequence_id"];
  Json reached;
  for (const Json& node : sent["nodes"]) {
    if (node["sequence_id"] == last) reached = node;
  }
  return {{"robot", sent["robot"]},
          {"order_id", sent["order"]["orderId"]},
          {"order_update_id", sent["order"]["orderUpdateId"]},
          {"last_released_sequence_id", last},
          {"action", reached["action"]},
          {"progress", reached["progress"]}};
}

TEST(Vda5050, UpdatesAnOrderFromTheEndOfItsBase) {
  Json body = exported(swap_request());
  const Json first = orders(body)["orders"];
  ASSERT_EQ(first.size(), 2U);
  body["progress"] = {at_end_of_base(first[0]), at_end_of_base(first[1])};
  const Json updates = orders(body)["orders"];
  ASSERT_FALSE(updates.empty());
  for (const Json& update : updates) {
    const Json& before = update["robot"] == "a" ? first[0] : first[1];
    const Json& order = update["order"];
    expect_order(order);
    EXPECT_EQ(order["orderUpdateId"], 1);
    EXPECT_EQ(order["orderId"], before["order"]["orderId"]);
    EXPECT_EQ(order["nodes"][0]["sequenceId"], before["last_released_sequence_id"]);
    EXPECT_GT(update["last_released_sequence_id"], before["last_released_sequence_id"]);
  }
  // A vehicle that has not moved on gets nothing.
  body["progress"] = {at_end_of_base(first[0]), at_end_of_base(first[1])};
  for (Json& progress : body["progress"]) progress["action"] = 0, progress["progress"] = 0.0;
  EXPECT_TRUE(orders(body)["orders"].empty());
}

/// A vehicle that reports nodes only.
struct Vehicle {
  Json order;                   // the last message
  std::map<int, Json> meaning;  // of sequence ids
  int at = 0;
  int released = 0;
};

/// Lets vehicles drive as far as they may, one at a time in random order. Returns the number of updates.
std::size_t drive_all(Json body, unsigned seed) {
  std::mt19937 random(seed);
  std::map<std::string, Vehicle> vehicles;
  std::size_t updates = 0;
  while (true) {
    Json progress = Json::array();
    for (const auto& [id, vehicle] : vehicles) {
      const Json& reached = vehicle.meaning.at(vehicle.at);
      progress.push_back({{"robot", id},
                          {"order_id", vehicle.order["orderId"]},
                          {"order_update_id", vehicle.order["orderUpdateId"]},
                          {"last_released_sequence_id", vehicle.released},
                          {"action", reached["action"]},
                          {"progress", reached["progress"]}});
    }
    body["progress"] = progress;
    const Json answer = orders(body);
    for (const Json& sent : answer["orders"]) {
      expect_order(sent["order"]);
      Vehicle& vehicle = vehicles[sent["robot"]];
      vehicle.order = sent["order"];
      vehicle.released = sent["last_released_sequence_id"];
      for (const Json& node : sent["nodes"]) vehicle.meaning[node["sequence_id"]] = node;
      ++updates;
    }
    std::vector<Vehicle*> able;
    bool all_arrived = true;
    for (auto& [id, vehicle] : vehicles) {
      all_arrived = all_arrived && vehicle.at == vehicle.meaning.rbegin()->first;
      if (vehicle.at < vehicle.released) able.push_back(&vehicle);
    }
    if (all_arrived) break;
    if (able.empty()) {
      ADD_FAILURE() << "vehicles wait for each other for ever";
      break;
    }
    Vehicle& next = *able[random() % able.size()];
    next.at = random() % 2 == 0 ? next.released : next.at + 2;
  }
  return updates;
}

TEST(Vda5050, LetsEveryoneArriveWhoReportsNodesOnly) {
  for (const auto& example : examples()) {
    if (example.name != "warehouse" && example.name != "lab-polygon") continue;
    const Json body = exported(Json::parse(example.body));
    for (unsigned seed = 0; seed < 3; ++seed) {
      EXPECT_GT(drive_all(body, seed), body["robots"].size()) << example.name << " seed " << seed;
    }
  }
}

TEST(Vda5050, RejectsWhatItCannotExport) {
  const Json valid = exported(swap_request());
  Json body = valid;
  body["version"] = "2.0.0";
  body["timestamp"] = "2026-01-31 12:00:00";
  body.erase("manufacturer");
  EXPECT_EQ(
      faults_of_export(body),
      (Faults{{"/version", "unknown_value"}, {"/timestamp", "out_of_range"}, {"/manufacturer", "missing"}}));
  body = valid;
  body.erase("dependencies");
  EXPECT_EQ(faults_of_export(body), (Faults{{"/dependencies", "missing"}}));

  body = valid;
  body["serial_numbers"] = {{"c", "1"}};
  body["manufacturers"] = {{"a", ""}, {"c", "acme"}};
  body["progress"] = Json::parse(R"([
    {"robot": "c", "action": 0, "progress": 0},
    {"robot": "a", "action": 1000, "progress": 0},
    {"robot": "a", "action": 0, "progress": 2},
    {"robot": "b", "action": 0, "progress": 0, "order_id": "x", "order_update_id": 0, "last_released_sequence_id": 1}])");
  EXPECT_EQ(faults_of_export(body), (Faults{{"/serial_numbers/c", "unknown_key"},
                                            {"/manufacturers/a", "empty"},
                                            {"/manufacturers/c", "unknown_key"},
                                            {"/progress/0/robot", "unknown_robot"},
                                            {"/progress/1/action", "out_of_range"},
                                            {"/progress/2/robot", "duplicate"},
                                            {"/progress/2/progress", "out_of_range"},
                                            {"/progress/3/last_released_sequence_id", "out_of_range"}}));

  // Of a robot without an order too, the members of one are what the document says.
  body = valid;
  body["progress"] = Json::parse(R"([
    {"robot": "a", "action": 0, "progress": 0, "order_update_id": null},
    {"robot": "b", "action": 0, "progress": 0, "order_id": null, "last_released_sequence_id": -1}])");
  EXPECT_EQ(faults_of_export(body), (Faults{{"/progress/0/order_update_id", "wrong_type"},
                                            {"/progress/1/last_released_sequence_id", "out_of_range"}}));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
