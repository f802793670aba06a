#include "server/http/library/decoded_body.h"

#include <utility>

#include "api/response/error.h"
#include "server/http/steps/negotiation.h"

namespace fleetplan::server {

std::optional<api::Reply> decode_body(Exchange& exchange, const httplib::ContentReader& reader,
                                      std::uint64_t limit) {
  using api::ErrorCode;
  if (content_coding(exchange.head.field("content-encoding")) == ContentCoding::identity) return std::nullopt;
  std::string decoded;
  bool too_large = false;
  bool has_room = true;
  const bool complete = reader([&](const char* data, std::size_t size) {
    too_large = size > limit - decoded.size();
    has_room = exchange.memory->grow_to(exchange.body.size() + decoded.size() + size);
    if (too_large || !has_room) return false;
    decoded.append(data, size);
    return true;
  });
  const auto problem = [&](ErrorCode code, const std::string& detail) {
    return api::problem_reply(code, detail, exchange.request_id);
  };
  if (too_large) {
    return problem(ErrorCode::body_too_large, "The body of " + std::to_string(exchange.body.size()) +
                                                  " bytes has more than " + std::to_string(limit) +
                                                  " bytes when decompressed, which is the limit.");
  }
  if (!has_room) return problem(ErrorCode::overloaded, BodyMemory::kFull);
  if (!complete) return problem(ErrorCode::malformed_request, "The body is not in gzip, as it is declared.");
  exchange.body = std::move(decoded);
  return std::nullopt;
}

}  // namespace fleetplan::server
