#include "api/endpoints/retime_endpoint.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "api/endpoints/within_memory.h"
#include "api/execution/parse_retime_request.h"
#include "api/execution/write_retimed.h"
#include "api/request/parse_body.h"
#include "api/response/error.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 8> kRetimeMembers{
    "robots", "robot_defaults", "plans", "dependencies", "at", "states", "options", "metadata"};

Reply retimed(std::string_view body, const RequestContext& context) {
  const auto read = [&](const JsonReader& root, ParseStop& stop) -> std::optional<std::string> {
    const auto request = parse_retime_request(root, context.limits, stop);
    if (!request) return std::nullopt;
    const auto times = core::retime(request->robots, core::executed_actions(request->robots, request->plans),
                                    request->dependencies, request->states, request->rules, stop.condition());
    if (!times) return std::nullopt;
    return write_retimed(*request, *times);
  };
  auto text = parse_body<std::string>(body, context.limits, context.parse_stop(), kRetimeMembers, read);
  if (!text) return problem_reply(text.failure(), context.request_id);
  return {200, kJson, std::move(*text)};
}

}  // namespace

Reply retime_endpoint(std::string_view body, const RequestContext& context) {
  return within_memory(context, [&] { return retimed(body, context); });
}

}  // namespace fleetplan::api
