#pragma once

// Orders of VDA 5050, POST /v1/export/vda5050: what a robot may do now (the base), and what comes later (the
// horizon). parse_export.cpp reads the request; write_orders.cpp names the nodes of orders and writes them.
//
// What is released of the orders that vehicles have when a plan begins cannot be taken back: the new plan has
// to begin with it, and the update of the order continues it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/request/limits.h"
#include "api/vda5050/route.h"
#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/segment.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The order that a vehicle has when its plan begins, by its last message.
struct OrderBase {
  std::string order_id;
  std::uint64_t update_id = 0;
  std::uint64_t sequence_id = 0;            // of the last node that is released
  JsonReader last;                          // this node, as it was sent
  std::vector<core::Position> still_to_do;  // the released nodes that the vehicle has not reached, in order
  std::vector<JsonReader> released;         // the released nodes, as they were sent
  bool has_horizon = false;                 // it has nodes that are not released
  bool is_unsure = false;                   // the vehicle may have reached some that are still to do
  bool is_known = false;                    // the vehicle has reported of it before
  std::unordered_set<std::string_view> finished;  // actions, by id, when the plan began
};

/// Returns the place in these actions from which on the robot stands.
core::ActionPlace last_stand(core::Actions actions);

/// Returns why an order cannot be continued by a plan, as a sentence; none if it can. It can if the robot is
/// committed to go past all that is still to do, and its committed motion ends there; and if it does not have
/// to wait for anybody on the way. `closed`: the first gate of the plan that is closed for the robot.
std::optional<std::string> why_it_ends(const OrderBase& base, const core::Robot& robot, core::Actions actions,
                                       const core::ActionPlace& closed, core::Work& work);

/// Ids of updates and sequences are unsigned numbers of 32 bits, and there is one after each.
inline constexpr std::uint64_t kGreatestId = 4'294'967'294;

/// Metres between which the last released node and the end of committed motion are the same: rounding.
inline constexpr double kSameNode = 1e-6;

/// Returns the value itself if it is an object; otherwise an absent one. Messages may have more members than
/// are known here.
inline JsonReader message(const JsonReader& value) {
  if (!value || value.value().is_object()) return value;
  value.must_be(fault::kWrongType, "an object");
  return {};
}

enum class VdaVersion : std::uint8_t { v2_1, v3_0 };

/// The members that all orders of an answer have.
struct OrderHeader {
  VdaVersion version = VdaVersion::v2_1;
  std::string manufacturer;  // of vehicles without one of their own
  std::string timestamp;     // ISO 8601
};

/// How far a robot is, and the order that it has.
struct OrderProgress {
  core::ActionPlace at;
  std::optional<std::string> order_id;             // none: it has no order yet
  std::uint64_t update_id = 0;                     // update of the last message
  std::uint64_t last_released = 0;                 // the sequence id of the last node of the base
  std::optional<std::string> cancel_id = {};       // of the action that cancels the order
  std::optional<std::string> ended_order_id = {};  // without an order: of the one that was cancelled or lost
  std::size_t served = 0;                          // goals of the plan, the first ones; opens no gates
};

/// What the messages to a vehicle say of it.
struct Vehicle {
  std::string manufacturer;
  std::string serial_number;
  std::string map_id;
};

/// A readable body of POST /v1/export/vda5050, in the client's world.
struct VdaRequest {
  OrderHeader header;
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  std::vector<Gate> gates;
  std::optional<double> release_ahead;          // seconds; none: all that is open
  std::optional<double> allowed_deviation;      // metres, of nodes
  std::vector<std::optional<OrderBase>> bases;  // by robot, as all of these
  std::vector<core::Actions> actions;           // of `robots` and `plans`
  std::vector<Route> routes;
  std::vector<OrderProgress> progress;
  std::vector<Vehicle> vehicles;
  std::vector<std::vector<JsonReader>> goals;  // of each robot, as they were received

  VdaRequest() = default;
  VdaRequest(VdaRequest&&) = default;  // a copy would refer to the actions of the original
  VdaRequest& operator=(VdaRequest&&) = default;
};

inline constexpr std::array<std::string_view, 18> kVdaMembers{
    "version",      "map",           "map_id",   "map_ids",      "robots",         "robot_defaults",
    "plans",        "options",       "base",     "dependencies", "release_ahead",  "progress",
    "manufacturer", "manufacturers", "metadata", "timestamp",    "serial_numbers", "allowed_deviation"};

/// Whether a text is a time in UTC, as messages have it: 2026-01-31T12:00:00.000Z.
bool is_timestamp(std::string_view text);

/// Reads the root of the document. Returns none if it has faults, or if `work` is met.
std::optional<VdaRequest> parse_vda5050_request(const JsonReader& root, const Limits& limits,
                                                core::Work& work);

/// An action of a node: one of a goal as the client has given it, or a service or wait of the plan.
struct NodeAction {
  std::string_view type;
  std::string_view blocking_type = "HARD";
  bool retriable = false;
  JsonReader parameters;                 // of an action of a goal; may be absent
  std::optional<Stop> stop = {};         // of the plan; none: an action of a goal
  std::optional<std::size_t> goal = {};  // that it serves; none: an added wait
};

/// Returns the actions of a node in their order: a goal's own ones, after a wait for its `not_before`;
/// otherwise its service.
std::vector<NodeAction> actions_of(const VdaRequest& request, std::size_t robot, const RouteNode& node);

/// The ids of nodes, edges and actions of a robot's order. Those of a plan that continues an order differ
/// from those that the order had, which the vehicle may know from its horizon.
class OrderNames {
 public:
  OrderNames(const VdaRequest& request, std::size_t robot, std::string_view order_id);

  std::string node(std::uint64_t sequence_id) const { return name_ + std::to_string(sequence_id); }
  std::string edge(std::uint64_t sequence_id) const { return node(sequence_id); }
  std::string action(std::uint64_t sequence_id, std::size_t index) const {
    return action_ + std::to_string(sequence_id) + "-" + std::to_string(index);
  }

 private:
  std::string name_;
  std::string action_;
};

/// Returns the answer of POST /v1/export/vda5050: an order for each robot with actions that has none, and an
/// update for each one of whose order more nodes can be released. With each, it tells what its nodes mean for
/// the plan. If orders have to be cancelled, it has the messages for that instead: until these vehicles
/// stand, nobody may go on by this plan, as they are not where it has them. Returns none if `work` is met.
std::optional<std::string> write_orders(const VdaRequest& request, core::Work& work);

/// Writes the members `action` and `progress` of a place.
void write_place(JsonWriter& json, const core::ActionPlace& place);

}  // namespace fleetplan::api
