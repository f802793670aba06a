#include "api/vda5050/write_order.h"

#include <numbers>
#include <string>
#include <string_view>

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

}  // namespace

void write_order(JsonWriter& json, const OrderHeader& header, const Order& order, const Route& route) {
  OrderWriter(json, header, order, route).write();
}

}  // namespace fleetplan::api
