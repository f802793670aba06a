#pragma once

#include <string>

#include "api/reply.h"
#include "server/answer_fields.h"

namespace fleetplan::server {

/// A whole answer as it goes over the wire, for those that the HTTP library has no part in: refusals and
/// preflights. `further` header fields come after those of every answer.
std::string answer_text(const Exchange& exchange, const api::Reply& reply, const HeaderFields& further);

}  // namespace fleetplan::server
