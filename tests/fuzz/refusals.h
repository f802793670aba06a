#pragma once

#include <string_view>

#include "api/response/reply.h"

namespace fleetplan::fuzz {

/// What every refusal of a body has to be: a problem of a status that blames the request, in strict JSON,
/// whose faults point to members that are there, or whose parents are.
void require_proper_refusal(std::string_view body, const api::Reply& reply);

}  // namespace fleetplan::fuzz
