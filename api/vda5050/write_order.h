#pragma once

#include "api/json/json_writer.h"
#include "api/vda5050/order.h"
#include "api/vda5050/route.h"

namespace fleetplan::api {

/// Writes an order message. The sequence id of node k of the route is 2 k, that of the edge after it 2 k + 1.
/// The names of members are those of the version.
void write_order(JsonWriter& json, const OrderHeader& header, const Order& order, const Route& route);

}  // namespace fleetplan::api
