#pragma once

#include <string_view>

#include "api/response/reply.h"

namespace fleetplan::fuzz {

/// Checks the rejection of a body: a problem with a status of the request's fault, in strict JSON,
/// whose faults point to members that are there, or whose parents are.
void require_proper_refusal(std::string_view body, const api::Reply& reply);

}  // namespace fleetplan::fuzz
