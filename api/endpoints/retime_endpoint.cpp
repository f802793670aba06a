#include "api/endpoints/retime_endpoint.h"

#include <array>
#include <optional>
#include <string>

#include "api/endpoints/pure_endpoint.h"
#include "api/execution/parse_retime_request.h"
#include "api/execution/write_retimed.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 8> kRetimeMembers{
    "robots", "robot_defaults", "plans", "dependencies", "at", "states", "options", "metadata"};

}  // namespace

Reply retime_endpoint(std::string_view body, const RequestContext& context) {
  const auto retimed = [&](const JsonReader& root, core::Work& stop,
                           const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto request = parse_retime_request(root, context.limits, stop);
    if (!request || !await_turn()) return std::nullopt;
    const auto times = core::retime(request->robots, core::executed_actions(request->robots, request->plans),
                                    request->dependencies, request->states, request->rules, stop.reading());
    if (!times) return std::nullopt;
    return write_retimed(*request, *times, stop);
  };
  return pure_endpoint(body, context, kRetimeMembers, retimed);
}

}  // namespace fleetplan::api
