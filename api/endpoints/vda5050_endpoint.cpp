#include "api/endpoints/vda5050_endpoint.h"

#include <optional>
#include <string>
#include <utility>

#include "api/endpoints/within_memory.h"
#include "api/request/parse_body.h"
#include "api/response/error.h"
#include "api/vda5050/parse_vda5050_request.h"
#include "api/vda5050/write_orders.h"

namespace fleetplan::api {

namespace {

Reply orders(std::string_view body, const RequestContext& context) {
  const auto read = [&](const JsonReader& root, ParseStop& stop) -> std::optional<std::string> {
    const auto request = parse_vda5050_request(root, context.limits, stop);
    if (!request) return std::nullopt;
    return write_orders(*request);
  };
  auto text = parse_body<std::string>(body, context.limits, context.parse_stop(), kVdaMembers, read);
  if (!text) return problem_reply(text.failure(), context.request_id);
  return {200, kJson, std::move(*text)};
}

}  // namespace

Reply vda5050_endpoint(std::string_view body, const RequestContext& context) {
  return within_memory(context, [&] { return orders(body, context); });
}

}  // namespace fleetplan::api
