#pragma once

// Reasons why a vehicle cannot do its work, by its reports, in words that a fleet manager can act on.

#include "api/json/json_writer.h"
#include "api/vda5050/export.h"
#include "api/vda5050/order_tracker.h"
#include "api/vda5050/vehicle_state.h"

namespace fleetplan::api {

/// Writes the member `availability` of a robot: all reasons why its vehicle does not go on with its order, or
/// would not take an order. `state`: null if there is no message from the vehicle.
void write_availability(JsonWriter& json, const OrderProgress& progress, const VehicleState* state,
                        const OrderTracker& tracker);

}  // namespace fleetplan::api
