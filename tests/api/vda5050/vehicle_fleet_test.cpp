// Simulated vehicles that refuse, fail, restart, are pushed by hand and send rubbish: gates open only for
// what vehicles have really passed, and nobody else is stopped for good.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

enum class Oddity { none, rubbish, silent, by_hand, other_map, lost, stale_number, other_sender };

/// A vehicle that drives from node to node of its order as far as it may, and reports it, unless it is odd.
struct Vehicle {
  Json order;                   // the last message
  std::map<int, Json> meaning;  // of sequence ids
  int at = 0;
  int released = 0;
  Oddity oddity = Oddity::none;

  /// The states of the nodes that are still to come.
  Json still_to_come() const {
    Json nodes = Json::array();
    for (const Json& node : order["nodes"]) {
      if (node["sequenceId"] > at) nodes.push_back({{"sequenceId", node["sequenceId"]}});
    }
    return nodes;
  }

  Json proper_state(const std::string& id) const {
    return {{"serialNumber", id},
            {"orderId", order["orderId"]},
            {"orderUpdateId", order["orderUpdateId"]},
            {"lastNodeId", "node"},
            {"lastNodeSequenceId", at},
            {"nodeStates", still_to_come()},
            {"edgeStates", Json::array()},
            {"driving", !still_to_come().empty()},
            {"operatingMode", "AUTOMATIC"},
            {"actionStates", finished_actions()}};
  }

  Json finished_actions() const {
    Json states = Json::array();
    for (const Json& node : order["nodes"]) {
      for (const Json& action : node["actions"]) {
        if (node["sequenceId"] > at) continue;
        states.push_back({{"actionId", action["actionId"]}, {"actionStatus", "FINISHED"}});
      }
    }
    return states;
  }

  /// What it reports instead while it is odd: as if it were at the end of what is released.
  Json state(const std::string& id, std::mt19937& random) const {
    Json state = proper_state(id);
    if (oddity == Oddity::none) return state;
    state["lastNodeSequenceId"] = released;
    state["nodeStates"] = nullptr;
    switch (oddity) {
      case Oddity::rubbish: {
        const std::vector<std::string> members{"orderId", "orderUpdateId", "lastNodeSequenceId",
                                               "operatingMode"};
        const std::vector<Json> values{Json::object(), Json(-1), Json(0.5), Json::array()};
        state[members[random() % members.size()]] = values[random() % values.size()];
        break;
      }
      case Oddity::by_hand:
        state["operatingMode"] = random() % 2 == 0 ? "MANUAL" : "INTERVENED";
        break;
      case Oddity::other_map:
        state["agvPosition"] = {{"mapId", "attic"}};
        break;
      case Oddity::lost:
        state["mobileRobotPosition"] = {{"localized", false}};
        break;
      case Oddity::stale_number:
        state["lastNodeId"] = "";
        break;
      case Oddity::other_sender:
        state["orderId"] = "of somebody else";
        break;
      case Oddity::none:
      case Oddity::silent:
        break;
    }
    return state;
  }
};

class Fleet {
 public:
  Fleet(Json body, unsigned seed) : body_(std::move(body)), random_(seed) {}

  /// Lets vehicles drive until all have arrived; each is odd now and then. Returns the number of odd reports.
  std::size_t drive() {
    std::size_t odd = 0;
    for (int round = 0; round < 1000 && !testing::Test::HasFailure(); ++round) {
      release();
      if (has_arrived()) return odd;
      for (auto& [id, vehicle] : vehicles_) {
        if (vehicle.at < vehicle.released && random_() % 3 == 0) vehicle.at += 2;
        const bool changes = random_() % 4 == 0;
        if (changes) vehicle.oddity = random_() % 2 == 0 ? Oddity::none : static_cast<Oddity>(random_() % 8);
        odd += vehicle.oddity == Oddity::none ? 0 : 1;
      }
      report();
    }
    ADD_FAILURE() << "somebody is stopped for good";
    return odd;
  }

 private:
  void release() {
    body_["progress"] = progress_;
    const Json answer = answer_of(vda5050_endpoint, body_);
    expect_no_more_than(answer);
    for (const Json& sent : answer["orders"]) {
      Vehicle& vehicle = vehicles_[sent["robot"]];
      vehicle.order = sent["order"];
      vehicle.released = sent["last_released_sequence_id"];
      for (const Json& node : sent["nodes"]) vehicle.meaning[node["sequence_id"]] = node;
      Json& known = progress_of(sent["robot"]);
      known["order_id"] = sent["order"]["orderId"];
      known["order_update_id"] = sent["order"]["orderUpdateId"];
      known["last_released_sequence_id"] = vehicle.released;
    }
  }

  Json& progress_of(const std::string& robot) {
    for (Json& entry : progress_) {
      if (entry["robot"] == robot) return entry;
    }
    progress_.push_back({{"robot", robot}, {"action", 0}, {"progress", 0.0}});
    return progress_.back();
  }

  /// Nothing is released that would not be if it were known where all vehicles really are.
  void expect_no_more_than(const Json& answer) {
    Json truly = body_;
    for (Json& entry : truly["progress"]) {
      const Vehicle& vehicle = vehicles_.at(entry["robot"]);
      const Json& reached = vehicle.meaning.at(vehicle.at);
      entry["action"] = reached["action"];
      entry["progress"] = reached["progress"];
    }
    std::map<std::string, int> most;
    for (const Json& sent : answer_of(vda5050_endpoint, truly)["orders"]) {
      most[sent["robot"]] = sent["last_released_sequence_id"];
    }
    for (const Json& sent : answer["orders"]) {
      const auto allowed = most.find(sent["robot"]);
      ASSERT_NE(allowed, most.end()) << "a gate is opened wrongly";
      EXPECT_LE(sent["last_released_sequence_id"], allowed->second) << "a gate is opened wrongly";
    }
  }

  void report() {
    body_["progress"] = progress_;
    body_["messages"] = Json::array();
    for (const auto& [id, vehicle] : vehicles_) {
      if (vehicle.oddity != Oddity::silent) body_["messages"].push_back(vehicle.state(id, random_));
    }
    const Json answer = answer_of(import_vda5050_endpoint, body_);
    body_.erase("messages");
    for (const Json& told : answer["vehicles"]) {
      const auto vehicle = vehicles_.find(told["robot"]);
      if (vehicle == vehicles_.end()) continue;
      const Oddity oddity = vehicle->second.oddity;
      const bool is_well = oddity == Oddity::none || oddity == Oddity::stale_number;
      EXPECT_EQ(told["availability"]["available"].get<bool>(), is_well) << told;
    }
    progress_ = Json::array();
    for (const Json& entry : answer["progress"]) {
      if (entry.contains("order_id")) progress_.push_back(entry);
    }
  }

  bool has_arrived() const {
    return std::all_of(vehicles_.begin(), vehicles_.end(), [](const auto& entry) {
      const Vehicle& vehicle = entry.second;
      return vehicle.at == vehicle.meaning.rbegin()->first && vehicle.oddity == Oddity::none;
    });
  }

  Json body_;
  std::mt19937 random_;
  Json progress_ = Json::array();
  std::map<std::string, Vehicle> vehicles_;
};

TEST(OddVehicles, OpenNoGateWronglyAndStopNobodyForGood) {
  for (const auto& example : examples()) {
    if (example.name != "lab-polygon") continue;
    Json request = Json::parse(example.body);
    request["options"] = {{"interval_margin", 0.5}, {"inflation", 0.01}, {"dependencies", true}};
    const Json plan = answer_of(plan_endpoint, request);
    ASSERT_EQ(plan["status"], "solved");
    Json body = {
        {"version", "3.0.0"},          {"manufacturer", "acme"}, {"timestamp", "2026-01-31T12:00:00.000Z"},
        {"robots", request["robots"]}, {"plans", plan["plans"]}, {"dependencies", plan["dependencies"]}};
    if (request.contains("robot_defaults")) body["robot_defaults"] = request["robot_defaults"];
    for (unsigned seed = 0; seed < 10; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      EXPECT_GT(Fleet(body, seed).drive(), body["robots"].size());
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
