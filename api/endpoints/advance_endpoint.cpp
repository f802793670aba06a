#include "api/endpoints/advance_endpoint.h"

#include <array>
#include <optional>
#include <string>

#include "api/advance/parse_advance_request.h"
#include "api/advance/write_advanced.h"
#include "api/endpoints/within_memory.h"
#include "api/request/parse_body.h"
#include "api/response/error.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 8> kMembers{"request", "plans", "at",    "commit",
                                                   "poses",   "holds", "goals", "pose_tolerance"};

Reply advance(std::string_view body, const RequestContext& context) {
  const auto read = [&](const JsonReader& root, ParseStop& stop) -> std::optional<std::string> {
    const auto request = parse_advance_request(root, context.limits, stop);
    if (!request) return std::nullopt;
    const auto robots = advanced(request->robots, request->executions, request->moment, stop);
    if (stop.met()) return std::nullopt;
    return write_advanced(*request, robots);
  };
  auto text = parse_body<std::string>(body, context.limits, context.parse_stop(), kMembers, read);
  if (!text) return problem_reply(text.failure(), context.request_id);
  return {200, kJson, std::move(*text)};
}

}  // namespace

Reply advance_endpoint(std::string_view body, const RequestContext& context) {
  return within_memory(context, [&] { return advance(body, context); });
}

}  // namespace fleetplan::api
