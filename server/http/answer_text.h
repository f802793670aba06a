#pragma once

#include <string>

#include "api/response/reply.h"
#include "server/http/answer_fields.h"

namespace fleetplan::server {

// Answers as they go over the wire, for those that the HTTP library has no part in.

/// The head, with the empty line that ends it.
std::string answer_head(const Exchange& exchange, int status, const HeaderFields& further);

/// A whole answer: refusals and preflights. `further` header fields come after those of every answer.
std::string answer_text(const Exchange& exchange, const api::Reply& reply, const HeaderFields& further);

}  // namespace fleetplan::server
