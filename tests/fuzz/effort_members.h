#pragma once

#include <nlohmann/json.hpp>

#include "tests/fuzz/effort_requests.h"

namespace fleetplan::fuzz {

/// Makes the rows of a request's map an image with the parameters of a map_server. Gives its masks such
/// parameters, and the parameters of a speed filter. Robots that do not fit there are usually reported.
void add_files(nlohmann::json& request, Choices& choices);

/// Gives robots ways to the pose of an open goal that they have chosen, previous or committed ones.
void add_chosen_ways(nlohmann::json& request, Choices& choices);

/// Gives messages of vehicles members about their availability: modes, faults, refusals, nodes to come and
/// other maps. Gives `progress` of a request to import them the orders that they have.
void add_vehicle_members(nlohmann::json& body, Choices& choices);

}  // namespace fleetplan::fuzz
