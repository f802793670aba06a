// Random fleets whose vehicles report what is right, late, wrong or impossible, in any order. Only a report
// that counts opens a gate, and all gates are open in the end.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/lives.h"
#include "tests/support/random_problem.h"
#include "tests/support/sanitized.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::Dice;

constexpr double kSame = 1e-6;  // of an action: rounding

/// An action and the fraction of it that is executed, as one number.
double place_of(const Json& json) { return json["action"].get<double>() + json["progress"].get<double>(); }

bool moves(const Json& action) {
  return action["from"]["x"] != action["to"]["x"] || action["from"]["y"] != action["to"]["y"];
}

/// Where a node is in the plan, and what is done there.
struct Node {
  double place = 0.0;
  double served = 0.0;  // where the services there are done
  std::vector<std::string> actions = {};
};

/// A vehicle that knows how far it is. What it says may be something else.
class Driver {
 public:
  explicit Driver(Json plan)
      : actions_(std::move(plan["actions"])), end_(static_cast<double>(actions_.size())) {}

  void take(const Json& sent) {
    order_ = sent["order"];
    released_ = sent["last_released_sequence_id"];
    for (std::size_t k = 0; k < sent["nodes"].size(); ++k) {
      Node node{place_of(sent["nodes"][k])};
      node.served = services_end(node.place);
      for (const Json& action : order_["nodes"][k]["actions"]) node.actions.push_back(action["actionId"]);
      nodes_[sent["nodes"][k]["sequence_id"]] = node;
    }
  }

  /// As far as it may: to the last released node, and what is done there.
  double most() const {
    if (order_.is_null()) return 0.0;
    return released_ == nodes_.rbegin()->first ? end_ : nodes_.at(released_).served;
  }
  void drive(Dice& dice) { at_ = std::min(most(), at_ + dice.between(0.0, 1.5)); }
  double at() const { return at_; }
  bool has_order() const { return !order_.is_null(); }
  double place_of_released() const { return has_order() ? nodes_.at(released_).place : 0.0; }

  /// The state of a vehicle that is so far.
  Json state_at(double place) const {
    std::int64_t last = 0;
    for (const auto& [sequence_id, node] : nodes_) {
      if (node.place <= place && sequence_id <= released_) last = sequence_id;
    }
    Json state{{"serialNumber", order_["serialNumber"]},
               {"orderId", order_["orderId"]},
               {"orderUpdateId", order_["orderUpdateId"]},
               {"lastNodeId", "n" + std::to_string(last)},
               {"lastNodeSequenceId", last},
               {"operatingMode", "AUTOMATIC"},
               {"driving", true}};
    state["agvPosition"] = position_at(place);
    state["nodeStates"] = state["edgeStates"] = state["actionStates"] = state["errors"] = Json::array();
    for (const auto& [sequence_id, node] : nodes_) {
      const bool is_done = sequence_id <= last && node.served <= place;
      for (const std::string& id : node.actions)
        state["actionStates"].push_back(
            {{"actionId", id}, {"actionStatus", is_done ? "FINISHED" : "WAITING"}});
      if (sequence_id > last) state["nodeStates"].push_back({{"sequenceId", sequence_id}});
    }
    return state;
  }

 private:
  Json position_at(double place) const {
    const auto index = std::min(static_cast<std::size_t>(place), actions_.size() - 1);
    const double share = std::min(1.0, place - static_cast<double>(index));
    const auto between = [&](const char* name) {
      const double from = actions_[index]["from"][name];
      return from + share * (actions_[index]["to"][name].get<double>() - from);
    };
    return {{"x", between("x")},
            {"y", between("y")},
            {"theta", 0.0},
            {"mapId", "hall"},
            {"positionInitialized", true}};
  }

  double services_end(double place) const {
    double end = place;
    if (place != std::floor(place)) return end;
    for (auto k = static_cast<std::size_t>(place); k < actions_.size() && !moves(actions_[k]); ++k) {
      if (actions_[k].contains("goal")) end = static_cast<double>(k + 1);
    }
    return end;
  }

  Json actions_;
  double end_;
  Json order_;
  std::int64_t released_ = 0;
  std::map<std::int64_t, Node> nodes_;  // by sequence id
  double at_ = 0.0;
};

/// Makes a state invalid, so that it must not count. Returns what is wrong with it.
std::string spoil(Json& state, Dice& dice) {
  static const std::vector<const char*> kWrongs{R"({"orderId": "another"})",
                                                R"({"orderUpdateId": 1000})",
                                                R"({"orderUpdateId": -1})",
                                                R"({"orderId": 7})",
                                                R"({"agvPosition": {"mapId": "attic"}})",
                                                R"({"agvPosition": {"positionInitialized": false}})",
                                                R"({"agvPosition": {"localized": false}})",
                                                R"({"agvPosition": {"x": 1e10}})",
                                                R"({"lastNodeSequenceId": 4000})",
                                                R"({"lastNodeSequenceId": "x"})",
                                                R"({"errors": [7]})",
                                                R"({"operatingMode": "MANUAL"})",
                                                R"({"operatingMode": "INTERVENED"})",
                                                R"({"operatingMode": "HOVERING"})",
                                                R"({"operatingMode": 7})",
                                                R"({"actionStates": [{}]})"};
  const char* wrong = kWrongs[static_cast<std::size_t>(dice.below(static_cast<int>(kWrongs.size())))];
  state.merge_patch(Json::parse(wrong));
  // A finished order counts whoever is in control. A mode that clears orders ends an order without nodes.
  if (state["nodeStates"].empty()) state["nodeStates"].push_back({{"sequenceId", 1'000'000}});
  return wrong;
}

/// Makes a state one after which a vehicle goes no further: it has dropped or forgotten its order, or failed
/// to do what it should. Returns what it says.
std::string end_by(Json& state, Dice& dice) {
  static const std::vector<const char*> kEnds{
      R"({"nodeStates": [], "edgeStates": [], "driving": false})",
      R"({"nodeStates": [], "operatingMode": "MANUAL"})",
      R"({"orderId": "", "lastNodeId": "", "nodeStates": [], "actionStates": []})"};
  const int kind = dice.below(static_cast<int>(kEnds.size()) + 1);
  if (kind < static_cast<int>(kEnds.size())) {
    state.merge_patch(Json::parse(kEnds[static_cast<std::size_t>(kind)]));
    return kEnds[static_cast<std::size_t>(kind)];
  }
  for (Json& action : state["actionStates"]) action["actionStatus"] = "FAILED";
  return "failed";
}

/// A fleet in a hall with a few walls.
Json random_request(Dice& dice) {
  constexpr int kSide = 10;
  Json request =
      Json::parse(R"({"map": {"rows": []}, "options": {"dependencies": true, "interval_margin": 0.3},
    "robot_defaults": {"radius": 0.35, "linear_speed": 1.0, "angular_speed": 2.0}, "robots": []})");
  std::vector<std::string> rows(kSide, std::string(kSide, '.'));
  std::vector<std::pair<int, int>> cells;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      if (dice.chance(0.12))
        rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = '#';
      else
        cells.emplace_back(column, kSide - 1 - row);
    }
  }
  request["map"]["rows"] = rows;
  const auto place = [&] {
    const auto index = static_cast<std::size_t>(dice.below(static_cast<int>(cells.size())));
    const auto [x, y] = cells[index];
    cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(index));
    return Json{{"x", x + 0.5}, {"y", y + 0.5}};
  };
  const int robots = 2 + dice.below(5);
  for (int k = 0; k < robots; ++k) {
    Json robot{{"id", "r" + std::to_string(k)}, {"start", place()}, {"goals", Json::array()}};
    for (int goals = 1 + dice.below(2); goals > 0; --goals) {
      robot["goals"].push_back(place());
      if (dice.chance(0.5)) robot["goals"].back()["service"] = 2.0;
    }
    request["robots"].push_back(robot);
  }
  return request;
}

/// The vehicles of a plan, what they have shown by reports that count, and what is released to them.
class Fleet {
 public:
  Fleet(Dice& dice, const Json& request, const Json& plan)
      : dice_(dice), dependencies_(plan["dependencies"]) {
    for (const char* member : {"robots", "robot_defaults", "options"}) body_[member] = request[member];
    for (const char* member : {"plans", "dependencies"}) body_[member] = plan[member];
    for (const Json& robot : plan["plans"]) {
      if (!robot["actions"].empty()) vehicles_.emplace(robot["robot"], Driver(robot));
    }
    ends_ = dice.chance(0.4);
    if (dice.chance(0.5)) body_["release_ahead"] = dice.between(2.0, 8.0);
  }

  /// `wrong`: the share of reports that do not count.
  void step(double wrong) {
    send();
    for (auto& [id, vehicle] : vehicles_) vehicle.drive(dice_);
    Json messages = Json::array();
    for (const auto& [id, vehicle] : vehicles_) {
      if (vehicle.has_order() && (wrong == 0.0 || dice_.chance(0.7)))
        messages.push_back(report(id, vehicle, wrong));
    }
    body_["messages"] = messages;
    const Json answer = answer_of(import_vda5050_endpoint, body_);
    body_.erase("messages");
    body_["progress"] = answer["progress"];
    for (const Json& progress : answer["progress"]) {
      ASSERT_LE(place_of(progress), shown_[progress["robot"]] + kSame) << progress << "\n" << told_;
    }
    has_arrived_ = std::all_of(answer["vehicles"].begin(), answer["vehicles"].end(),
                               [](const Json& vehicle) { return vehicle["arrived"].get<bool>(); });
  }

  bool has_arrived() const { return has_arrived_; }
  /// Whether vehicles may have gone no further.
  bool ends() const { return ends_; }

 private:
  void send() {
    const Json answer = answer_of(vda5050_endpoint, body_);
    for (const Json& sent : answer["orders"]) {
      const std::string id = sent["robot"];
      vehicles_.at(id).take(sent);
      Json& progress = progress_of(id);
      progress["order_id"] = sent["order"]["orderId"];
      progress["order_update_id"] = sent["order"]["orderUpdateId"];
      progress["last_released_sequence_id"] = sent["last_released_sequence_id"];
    }
    for (const Json& dependency : dependencies_) {
      const Json &gate = dependency["gate"], &until = dependency["until"];
      const auto vehicle = vehicles_.find(gate["robot"]);
      if (vehicle == vehicles_.end() || vehicle->second.place_of_released() <= place_of(gate) + kSame)
        continue;
      ASSERT_GE(shown_[until["robot"]], place_of(until) - kSame) << dependency << "\n" << told_;
    }
  }

  Json& progress_of(const std::string& id) {
    for (Json& entry : body_["progress"]) {
      if (entry["robot"] == id) return entry;
    }
    body_["progress"].push_back({{"robot", id}, {"action", 0}, {"progress", 0.0}});
    return body_["progress"].back();
  }

  Json report(const std::string& id, const Driver& vehicle, double wrong) {
    Json& before = reported_[id];
    if (ends_ && dice_.chance(0.05 * wrong)) {
      Json state = vehicle.state_at(vehicle.at());
      shown_[id] = std::max(shown_[id], vehicle.at());
      told_ += id + " " + end_by(state, dice_) + "\n";
      return state;
    }
    if (dice_.chance(wrong)) {
      Json state = vehicle.state_at(dice_.between(vehicle.at(), vehicle.most()));
      told_ += id + " " + spoil(state, dice_) + "\n";
      return state;
    }
    if (!before.is_null() && dice_.chance(wrong)) return before;  // it comes again, late
    shown_[id] = std::max(shown_[id], vehicle.at());
    return before = vehicle.state_at(vehicle.at());
  }

  Dice& dice_;
  Json dependencies_;
  Json body_{{"version", "2.1.0"},
             {"manufacturer", "acme"},
             {"timestamp", "2026-11-23T12:00:00.000Z"},
             {"map_id", "hall"},
             {"progress", Json::array()}};
  std::map<std::string, Driver> vehicles_;
  std::map<std::string, double> shown_;  // how far each is, by its reports that count
  std::map<std::string, Json> reported_;
  std::string told_;
  bool has_arrived_ = false;
  bool ends_ = false;
};

TEST(RandomReports, OpenNoGateWrongly) {
  constexpr int kSteps = 60;
  constexpr int kStepsToTheEnd = 400;
  const std::uint64_t fleets = from_environment("FLEETPLAN_ROUNDS", support::kSanitized ? 15 : 40);
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 1);
  int dependencies = 0;
  for (std::uint64_t seed = first; seed < first + fleets; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const Json request = random_request(dice);
    const Json plan = plan_of(request);
    if (plan["dependencies"].is_null() || !plan["tight"].empty()) continue;
    dependencies += static_cast<int>(plan["dependencies"].size());
    Fleet fleet(dice, request, plan);
    for (int k = 0; k < kSteps && !testing::Test::HasFailure(); ++k) fleet.step(0.5);
    if (fleet.ends()) continue;
    for (int k = 0; k < kStepsToTheEnd && !fleet.has_arrived() && !testing::Test::HasFailure(); ++k)
      fleet.step(0.0);
    ASSERT_TRUE(fleet.has_arrived());
  }
  EXPECT_GT(dependencies, static_cast<int>(fleets));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
