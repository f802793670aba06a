#include "api/vda5050/write_orders.h"

#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_writer.h"
#include "api/vda5050/parse_vda5050_request.h"
#include "api/vda5050/route.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

class OrderWriter {
 public:
  OrderWriter(JsonWriter& json, const OrderHeader& header, const Order& order, const Route& route)
      : json_(json), header_(header), order_(order), route_(route) {}

  void write() {
    json_.begin_object().member("headerId", order_.update_id).member("timestamp", header_.timestamp);
    json_.member("version", is_v3() ? "3.0.0" : "2.1.0").member("manufacturer", header_.manufacturer);
    json_.member("serialNumber", order_.serial_number).member("orderId", order_.order_id);
    json_.member("orderUpdateId", order_.update_id).key("nodes").begin_array();
    for (std::size_t k = order_.first; k < route_.nodes.size(); ++k) write_node(k);
    json_.end_array().key("edges").begin_array();
    for (std::size_t k = order_.first; k < route_.edges.size(); ++k) write_edge(k);
    json_.end_array().end_object();
  }

 private:
  bool is_v3() const { return header_.version == VdaVersion::v3_0; }
  std::string node_id(std::size_t k) const { return order_.robot + "-" + std::to_string(2 * k); }

  void write_node(std::size_t k) {
    const RouteNode& node = route_.nodes[k];
    json_.begin_object().member("nodeId", node_id(k)).member("sequenceId", 2 * k);
    json_.member("released", k < order_.released).key("nodePosition").begin_object();
    json_.member("x", node.position.x()).member("y", node.position.y());
    if (node.theta) json_.member("theta", core::normalize_angle(*node.theta));
    json_.member("mapId", header_.map_id).end_object().key("actions").begin_array();
    for (std::size_t s = 0; s < node.stops.size(); ++s) write_stop(node.stops[s], k, s);
    json_.end_array().end_object();
  }

  void write_stop(const Stop& stop, std::size_t node, std::size_t index) {
    json_.begin_object().member("actionType", stop.goal ? "fleetplanService" : "fleetplanWait");
    json_.member("actionId", order_.order_id + "-" + std::to_string(2 * node) + "-" + std::to_string(index));
    json_.member("blockingType", "HARD").key("actionParameters").begin_array();
    write_parameter("duration", stop.duration);
    if (stop.goal) write_parameter("goal", *stop.goal);
    if (stop.not_before > 0.0) write_parameter("notBefore", stop.not_before);
    json_.end_array().end_object();
  }

  template <typename Value>
  void write_parameter(std::string_view key, const Value& value) {
    json_.begin_object().member("key", key).member("value", value).end_object();
  }

  void write_edge(std::size_t k) {
    const RouteEdge& edge = route_.edges[k];
    const bool turns_only = edge.length == 0.0;
    json_.begin_object().member("edgeId", order_.robot + "-" + std::to_string(2 * k + 1));
    json_.member("sequenceId", 2 * k + 1).member("released", k + 1 < order_.released);
    if (!is_v3()) json_.member("startNodeId", node_id(k)).member("endNodeId", node_id(k + 1));
    if (!turns_only) {
      json_.member(is_v3() ? "maximumSpeed" : "maxSpeed", edge.speed);
      json_.member("orientation", edge.reverse ? std::numbers::pi : 0.0);
      json_.member("orientationType", "TANGENTIAL");
    }
    json_.member(is_v3() ? "maximumRotationSpeed" : "maxRotationSpeed", edge.rotation_speed);
    if (!is_v3()) json_.member("rotationAllowed", turns_only);
    json_.member("length", edge.length).key("actions").begin_array().end_array().end_object();
  }

  JsonWriter& json_;
  const OrderHeader& header_;
  const Order& order_;
  const Route& route_;
};

/// Writes an order message. The sequence id of node k of the route is 2 k, that of the edge after it 2 k + 1.
/// The names of members are those of the version.
void write_order(JsonWriter& json, const OrderHeader& header, const Order& order, const Route& route) {
  OrderWriter(json, header, order, route).write();
}

/// Returns the order to send to a robot; none if it has no actions, or if nothing more is released than it
/// knows.
std::optional<Order> next_order(const VdaRequest& request, std::size_t robot, std::size_t released) {
  const OrderProgress& progress = request.progress[robot];
  const std::string& id = request.robots[robot].id;
  Order order{.robot = id,
              .serial_number = request.serial_numbers[robot],
              .order_id = {},
              .update_id = 0,
              .first = 0,
              .released = released};
  if (!progress.order_id) {
    order.order_id = id + "-" + request.header.timestamp;
    return order;
  }
  order.order_id = *progress.order_id;
  order.update_id = progress.update_id + 1;
  order.first = progress.last_released / 2;
  if (released <= order.first + 1) return std::nullopt;
  return order;
}

void write_progress(JsonWriter& json, const Route& route, std::size_t first) {
  json.key("nodes").begin_array();
  for (std::size_t k = first; k < route.nodes.size(); ++k) {
    const core::ActionPlace& at = route.nodes[k].at;
    // At the end of an action, its progress is 1.
    const bool is_end = at.fraction == 0.0 && at.action > 0;
    json.begin_object().member("sequence_id", 2 * k);
    json.member("action", is_end ? at.action - 1 : at.action);
    json.member("progress", is_end ? 1.0 : at.fraction).end_object();
  }
  json.end_array();
}

}  // namespace

std::optional<std::string> write_orders(const VdaRequest& request, core::Work& stop) {
  // The work of writing a node and its edge, in bytes of text.
  constexpr std::size_t kWorkOfANode = 1024;
  const std::vector<Route>& routes = request.routes;
  std::vector<core::ActionPlace> reached;
  reached.reserve(request.progress.size());
  for (const OrderProgress& progress : request.progress) reached.push_back(progress.at);
  const auto released = released_nodes(routes, request.dependencies, reached);
  bool all_released = true;
  JsonWriter json;
  json.begin_object().key("orders").begin_array();
  for (std::size_t k = 0; k < routes.size(); ++k) {
    if (routes[k].nodes.empty()) continue;
    if (stop.met_after(kWorkOfANode * routes[k].nodes.size())) return std::nullopt;
    all_released = all_released && released[k] == routes[k].nodes.size();
    const auto order = next_order(request, k, released[k]);
    if (!order) continue;
    json.begin_object().member("robot", order->robot).key("order");
    write_order(json, request.header, *order, routes[k]);
    json.member("last_released_sequence_id", 2 * (released[k] - 1));
    write_progress(json, routes[k], order->first);
    json.end_object();
  }
  json.end_array().member("all_released", all_released).end_object();
  return json.take();
}

}  // namespace fleetplan::api
