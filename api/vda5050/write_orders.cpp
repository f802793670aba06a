#include "api/vda5050/write_orders.h"

#include <optional>
#include <vector>

#include "api/json/json_writer.h"
#include "api/vda5050/release.h"
#include "api/vda5050/write_order.h"

namespace fleetplan::api {

namespace {

/// The order to send to a robot; nothing if it has no actions, or nothing more is released than it knows.
std::optional<Order> next_order(const VdaRequest& request, std::size_t robot, std::size_t released) {
  const OrderProgress& progress = request.progress[robot];
  const std::string& id = request.robots[robot].id;
  Order order{id, request.serial_numbers[robot], {}, 0, 0, released};
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
    // The end of an action is its progress 1.
    const bool is_end = at.fraction == 0.0 && at.action > 0;
    json.begin_object().member("sequence_id", 2 * k);
    json.member("action", is_end ? at.action - 1 : at.action);
    json.member("progress", is_end ? 1.0 : at.fraction).end_object();
  }
  json.end_array();
}

}  // namespace

std::optional<std::string> write_orders(const VdaRequest& request, core::Work& stop) {
  // The text of a node and its edge.
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
