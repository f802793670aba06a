#pragma once

#include <string_view>

#include "api/response/reply.h"

namespace fleetplan::fuzz {

/// Requires a well-formed rejection of a body: a problem document with status 400 or 422. Its faults point to
/// members of the body, or to missing members of one of its objects.
void require_proper_refusal(std::string_view body, const api::Reply& reply);

}  // namespace fleetplan::fuzz
