#include <algorithm>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_writer.h"
#include "api/vda5050/export.h"
#include "api/vda5050/route.h"
#include "core/geometry/position.h"

namespace fleetplan::api {

namespace {

/// Returns the actions that the client has given a goal; none if it has not.
std::vector<NodeAction> given_actions(const std::vector<JsonReader>& goals, std::size_t goal) {
  std::vector<NodeAction> actions;
  if (goal >= goals.size()) return actions;
  for (const JsonReader given : goals[goal].find("actions").items()) {
    actions.push_back({.type = given.find("type").string().value_or(""),
                       .blocking_type = given.find("blocking_type").string().value_or("HARD"),
                       .retriable = given.find("retriable").boolean().value_or(false),
                       .parameters = given.find("parameters"),
                       .goal = goal});
  }
  return actions;
}

}  // namespace

std::vector<NodeAction> actions_of(const VdaRequest& request, std::size_t robot, const RouteNode& node) {
  std::vector<NodeAction> actions;
  const std::vector<JsonReader>& goals = request.goals[robot];
  // Bounded: the actions in the body, of goals that occur in one stop each.
  for (const Stop& stop : node.stops) {
    std::vector<NodeAction> given;
    if (stop.goal) given = given_actions(goals, *stop.goal);
    Stop own = stop;
    if (!given.empty()) own.duration = 0.0;
    if (given.empty() || own.not_before > 0.0) {
      actions.push_back({.type = stop.goal ? "fleetplanService" : "fleetplanWait",
                         .parameters = {},
                         .stop = own,
                         .goal = stop.goal});
    }
    actions.insert(actions.end(), given.begin(), given.end());
  }
  return actions;
}

OrderNames::OrderNames(const VdaRequest& request, std::size_t robot, std::string_view order_id)
    : name_(request.robots[robot].id + "-"), action_(std::string(order_id) + "-") {
  const auto& base = request.bases[robot];
  if (!base) return;
  const std::string update = std::to_string(base->update_id + 1) + "-";
  name_ += update;
  action_ += update;
}

namespace {

/// An order, or an update of one, of a robot's route from a node on.
struct Order {
  std::string order_id;
  std::uint64_t update_id = 0;
  std::size_t first = 0;     // index of its first node
  std::size_t released = 1;  // the number of nodes of the whole route that are released, > first
};

bool is_v3(const OrderHeader& header) { return header.version == VdaVersion::v3_0; }

/// Begins a message to a vehicle with the members that all messages have.
void begin_message(JsonWriter& json, const OrderHeader& header, const Vehicle& vehicle, std::uint64_t id) {
  json.begin_object().member("headerId", id).member("timestamp", header.timestamp);
  json.member("version", is_v3(header) ? "3.0.0" : "2.1.0").member("manufacturer", vehicle.manufacturer);
  json.member("serialNumber", vehicle.serial_number);
}

template <typename Value>
void write_parameter(JsonWriter& json, std::string_view key, const Value& value) {
  json.begin_object().member("key", key).member("value", value).end_object();
}

/// Writes an order message. The names of members depend on the version.
class OrderWriter {
 public:
  OrderWriter(JsonWriter& json, const VdaRequest& request, std::size_t robot, const Order& order)
      : json_(json),
        header_(request.header),
        vehicle_(request.vehicles[robot]),
        base_(request.bases[robot]),
        route_(request.routes[robot]),
        order_(order),
        names_(request, robot, order.order_id),
        robot_(robot),
        request_(request) {}

  void write() {
    begin_message(json_, header_, vehicle_, order_.update_id);
    json_.member("orderId", order_.order_id);
    json_.member("orderUpdateId", order_.update_id).key("nodes").begin_array();
    for (std::size_t k = order_.first; k < route_.nodes.size(); ++k) write_node(k);
    json_.end_array().key("edges").begin_array();
    for (std::size_t k = order_.first; k < route_.edges.size(); ++k) write_edge(k);
    json_.end_array().end_object();
  }

 private:
  bool is_v3() const { return api::is_v3(header_); }
  bool is_of_base(std::size_t node) const { return base_ && node == 0; }
  std::string node_id(std::size_t k) const {
    if (is_of_base(k)) return std::string(*base_->last.find("nodeId").string());
    return names_.node(route_.sequence_id(k));
  }

  void write_node(std::size_t k) {
    if (is_of_base(k)) return copy_without_null(json_, base_->last.value());
    const RouteNode& node = route_.nodes[k];
    json_.begin_object().member("nodeId", node_id(k)).member("sequenceId", route_.sequence_id(k));
    json_.member("released", k < order_.released).key("nodePosition").begin_object();
    json_.member("x", node.position.x()).member("y", node.position.y());
    if (node.theta) json_.member("theta", core::normalize_angle(*node.theta));
    write_deviation();
    json_.member("mapId", vehicle_.map_id).end_object().key("actions").begin_array();
    std::size_t index = 0;
    for (const NodeAction& action : actions_of(request_, robot_, node)) {
      write_action(action, names_.action(route_.sequence_id(k), index++));
    }
    json_.end_array().end_object();
  }

  void write_deviation() {
    const auto& deviation = request_.allowed_deviation;
    if (!deviation) return;
    if (!is_v3()) {
      json_.member("allowedDeviationXY", *deviation);
      return;
    }
    json_.key("allowedDeviationXY").begin_object().member("a", *deviation).member("b", *deviation);
    json_.member("theta", 0.0).end_object();
  }

  void write_action(const NodeAction& action, const std::string& id) {
    // Up to 2.1 no type allows driving, but no other actions: HARD allows neither.
    const bool is_known = is_v3() || action.blocking_type != "SINGLE";
    json_.begin_object().member("actionType", action.type).member("actionId", id);
    json_.member("blockingType", is_known ? action.blocking_type : "HARD");
    if (is_v3() && action.retriable) json_.member("retriable", true);
    json_.key("actionParameters").begin_array();
    if (action.stop) write_stop(*action.stop);
    // Bounded: the text of the request, which is copied.
    for (const JsonReader parameter : action.parameters.members()) {
      if (parameter.is_null()) continue;
      json_.begin_object().member("key", parameter.value().key()).key("value");
      copy_without_null(json_, parameter.value());
      json_.end_object();
    }
    json_.end_array().end_object();
  }

  void write_stop(const Stop& stop) {
    write_parameter(json_, "duration", stop.duration);
    if (stop.goal) write_parameter(json_, "goal", *stop.goal);
    if (stop.not_before > 0.0) write_parameter(json_, "notBefore", stop.not_before);
  }

  void write_edge(std::size_t k) {
    const RouteEdge& edge = route_.edges[k];
    const bool turns_only = edge.length == 0.0;
    const std::uint64_t sequence_id = route_.sequence_id(k) + 1;
    json_.begin_object().member("edgeId", names_.edge(sequence_id));
    json_.member("sequenceId", sequence_id).member("released", k + 1 < order_.released);
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
  const Vehicle& vehicle_;
  const std::optional<OrderBase>& base_;
  const Route& route_;
  const Order& order_;
  OrderNames names_;
  std::size_t robot_;
  const VdaRequest& request_;
};

/// Returns the order to send to a robot; none if nothing more is released than it knows, or if its order is
/// being cancelled.
std::optional<Order> next_order(const VdaRequest& request, std::size_t robot, std::size_t released) {
  const OrderProgress& progress = request.progress[robot];
  if (progress.cancel_id) return std::nullopt;
  // Where a vehicle stands whose order was cancelled or lost is not in the plan.
  if (!progress.order_id && (request.bases[robot] || progress.ended_order_id)) return std::nullopt;
  const Route& route = request.routes[robot];
  const bool has_work = route.nodes.size() > 1 || !route.nodes.front().stops.empty();
  if (!progress.order_id && !has_work) return std::nullopt;
  if (!progress.order_id) {
    return Order{.order_id = request.robots[robot].id + "-" + request.header.timestamp, .released = released};
  }
  const Order order{.order_id = *progress.order_id,
                    .update_id = progress.update_id + 1,
                    .first = route.node_of(progress.last_released).value_or(0),
                    .released = released};
  return released > order.first + 1 ? std::optional(order) : std::nullopt;
}

void write_nodes(JsonWriter& json, const Route& route, std::size_t first) {
  json.key("nodes").begin_array();
  for (std::size_t k = first; k < route.nodes.size(); ++k) {
    json.begin_object().member("sequence_id", route.sequence_id(k));
    write_place(json, route.nodes[k].at);
    json.end_object();
  }
  json.end_array();
}

/// The work of writing a node and its edge, in bytes of text.
constexpr std::size_t kWorkOfANode = 1024;

/// Writes the messages that cancel the orders of robots whose plans do not go on with what is released of
/// them.
class Cancellations {
 public:
  Cancellations(const VdaRequest& request, const std::vector<core::ActionPlace>& closed, core::Work& work)
      : request_(request), closed_(closed), work_(work) {}

  /// Returns whether there are any.
  bool write(JsonWriter& json) {
    bool any = false;
    json.key("cancel_orders").begin_array();
    for (std::size_t k = 0; k < request_.robots.size() && !work_.met_after(kWorkOfANode); ++k) {
      if (!request_.bases[k] || !request_.progress[k].order_id) continue;
      const auto why =
          why_it_ends(*request_.bases[k], request_.robots[k], request_.actions[k], closed_[k], work_);
      if (!why) continue;
      any = true;
      json.begin_object().member("robot", request_.robots[k].id).member("detail", *why);
      write_message(json, k);
      json.end_object();
    }
    json.end_array();
    return any;
  }

 private:
  void write_message(JsonWriter& json, std::size_t robot) const {
    const std::string& order_id = request_.bases[robot]->order_id;
    const std::uint64_t id = std::max(request_.bases[robot]->update_id, request_.progress[robot].update_id);
    json.key("instant_actions");
    begin_message(json, request_.header, request_.vehicles[robot], id);
    json.key("actions").begin_array().begin_object().member("actionType", "cancelOrder");
    json.member("actionId", order_id + "-" + std::to_string(id) + "-cancel").member("blockingType", "NONE");
    json.key("actionParameters").begin_array();
    if (is_v3(request_.header)) write_parameter(json, "orderId", order_id);
    json.end_array().end_object().end_array().end_object();
  }

  const VdaRequest& request_;
  const std::vector<core::ActionPlace>& closed_;
  core::Work& work_;
};

/// By robot, how many nodes of its route are released.
std::vector<std::size_t> released_of_all(const VdaRequest& request,
                                         const std::vector<core::ActionPlace>& closed) {
  std::vector<std::size_t> released;
  released.reserve(request.routes.size());
  for (std::size_t k = 0; k < request.routes.size(); ++k) {
    const Route& route = request.routes[k];
    std::size_t nodes = released_nodes(route, closed[k]);
    if (request.release_ahead) {
      const core::ActionPlace& at = request.progress[k].at;
      nodes = std::min(nodes, nodes_within(*request.release_ahead, route, request.actions[k], at));
    }
    released.push_back(nodes);
  }
  return released;
}

}  // namespace

void write_place(JsonWriter& json, const core::ActionPlace& place) {
  // At the end of an action, its progress is 1.
  const bool is_end = place.fraction == 0.0 && place.action > 0;
  json.member("action", is_end ? place.action - 1 : place.action);
  json.member("progress", is_end ? 1.0 : place.fraction);
}

std::optional<std::string> write_orders(const VdaRequest& request, core::Work& work) {
  std::vector<core::ActionPlace> reached;
  reached.reserve(request.progress.size());
  for (const OrderProgress& progress : request.progress) reached.push_back(progress.at);
  const auto closed = closed_gates(request.gates, reached);
  JsonWriter json;
  json.begin_object();
  bool all_released = !Cancellations(request, closed, work).write(json);
  const bool goes_on = all_released;
  const auto released = released_of_all(request, closed);
  json.key("orders").begin_array();
  for (std::size_t k = 0; goes_on && k < request.routes.size(); ++k) {
    const Route& route = request.routes[k];
    if (route.nodes.empty()) continue;
    if (work.met_after(kWorkOfANode * route.nodes.size())) return std::nullopt;
    all_released = all_released && released[k] == route.nodes.size();
    const auto order = next_order(request, k, released[k]);
    if (!order) continue;
    json.begin_object().member("robot", request.robots[k].id).key("order");
    OrderWriter(json, request, k, *order).write();
    json.member("last_released_sequence_id", route.sequence_id(released[k] - 1));
    write_nodes(json, route, order->first);
    json.end_object();
  }
  json.end_array().member("all_released", all_released).end_object();
  return work.met() ? std::nullopt : std::optional(json.take());
}

}  // namespace fleetplan::api
