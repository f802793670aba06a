#pragma once

// Orders of VDA 5050, POST /v1/export/vda5050: what a robot may do now (the base), and what comes later (the
// horizon). The request is read in parse_export.cpp. The nodes of orders are named and written in
// write_orders.cpp.
//
// When a plan begins, vehicles may have orders with a released part, which cannot be taken back. The new plan
// must begin with it, and the update of the order continues it.

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

/// Returns why an order cannot be continued by a plan, as a sentence; none if it can be. It can be continued
/// if all of these hold:
///
/// - The robot's commitment goes past everything that is still to do, and its committed motion ends there.
/// - The robot does not have to wait for others on the way.
///
/// `closed`: the first gate of the plan that is closed for the robot.
std::optional<std::string> why_it_ends(const OrderBase& base, const core::Robot& robot, core::Actions actions,
                                       const core::ActionPlace& closed, core::Work& work);

/// Ids of updates and sequences are unsigned numbers of 32 bits. Each of them has a successor, so this is not
/// the greatest number.
inline constexpr std::uint64_t kGreatestId = 4'294'967'294;

/// Metres: if the last released node and the end of committed motion are nearer than this, they are the same.
/// It covers rounding.
inline constexpr double kSameNode = 1e-6;

/// Returns the value itself if it is an object, otherwise an absent value. Messages may have more members
/// than are known here.
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
  std::optional<std::string> ended_order_id = {};  // without an order: the id of the order that was cancelled
                                                   // or lost
  std::size_t served = 0;                          // goals of the plan, the first ones; opens no gates
};

/// What the messages to a vehicle say about it.
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

/// An action of a node: an action of a goal as the client has given it, or a service or wait of the plan.
struct NodeAction {
  std::string_view type;
  std::string_view blocking_type = "HARD";
  bool retriable = false;
  JsonReader parameters;                 // of an action of a goal; may be absent
  std::optional<Stop> stop = {};         // of the plan; none: an action of a goal
  std::optional<std::size_t> goal = {};  // that it serves; none: an added wait
};

/// Returns the actions of a node in their order: a goal's own actions, after a wait for its `not_before`;
/// otherwise, its service.
std::vector<NodeAction> actions_of(const VdaRequest& request, std::size_t robot, const RouteNode& node);

/// The ids of nodes, edges and actions of a robot's order. If a plan continues an order, it uses new ids: the
/// vehicle may know the old ones from its horizon.
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

/// Returns the answer of POST /v1/export/vda5050. A robot with actions and without an order gets an order. A
/// robot gets an update if more nodes of its order can be released. With each, the answer tells what its
/// nodes mean for the plan. Returns none if `work` is met.
///
/// If orders have to be cancelled, the answer has the messages for this instead. Until these vehicles stand,
/// no robot may go on by this plan, because they are not where it has them.
std::optional<std::string> write_orders(const VdaRequest& request, core::Work& work);

/// Writes the members `action` and `progress` of a place.
void write_place(JsonWriter& json, const core::ActionPlace& place);

}  // namespace fleetplan::api
