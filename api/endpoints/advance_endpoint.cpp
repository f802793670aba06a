#include "api/endpoints/advance_endpoint.h"

#include <array>
#include <optional>
#include <string>

#include "api/advance/parse_advance_request.h"
#include "api/advance/write_advanced.h"
#include "api/endpoints/pure_endpoint.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 8> kMembers{"request", "plans", "at",    "commit",
                                                   "poses",   "holds", "goals", "pose_tolerance"};

}  // namespace

Reply advance_endpoint(std::string_view body, const RequestContext& context) {
  const auto next_request = [&](const JsonReader& root, core::Work& stop,
                                const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto request = parse_advance_request(root, context.limits, stop);
    if (!request || !await_turn()) return std::nullopt;
    const auto robots = advanced(request->robots, request->executions, request->moment, stop);
    if (stop.met()) return std::nullopt;
    return write_advanced(*request, robots, stop);
  };
  return pure_endpoint(body, context, kMembers, next_request);
}

}  // namespace fleetplan::api
