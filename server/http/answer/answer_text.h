#pragma once

#include <string>

#include "api/json/error.h"
#include "api/response/reply.h"
#include "server/http/exchange.h"

namespace fleetplan::server {

// Answers that the HTTP library does not write: to requests that it never sees, and streams of events.

/// An answer without a handler: a refusal, or the reply to a browser's preflight.
struct DirectAnswer {
  api::Reply reply;
  HeaderFields fields = {};  // header fields of this answer only
};

/// Returns a problem in answer to the exchange.
DirectAnswer refusal(const Exchange& exchange, api::ErrorCode code, const std::string& detail,
                     HeaderFields fields = {});

/// Returns the header fields of every answer, whether the library writes it or not.
HeaderFields common_fields(const Exchange& exchange);

/// Returns a head, with the empty line that ends it. `further` header fields follow those of every answer.
std::string answer_head(const Exchange& exchange, int status, const HeaderFields& further);

/// Returns the whole answer as it is sent.
std::string answer_text(const Exchange& exchange, const DirectAnswer& answer);

}  // namespace fleetplan::server
