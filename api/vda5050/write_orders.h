#pragma once

// Orders of VDA 5050: the names of their nodes and actions, the actions of their nodes, and their text.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/vda5050/parse_vda5050_request.h"
#include "api/vda5050/route.h"

namespace fleetplan::api {

/// An action of a node: one of a goal as the client has given it, or a service or wait of the plan.
struct NodeAction {
  std::string_view type;
  std::string_view blocking_type = "HARD";
  JsonReader parameters;          // of an action of a goal; may be absent
  std::optional<Stop> stop = {};  // of the plan; none: an action of a goal
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
