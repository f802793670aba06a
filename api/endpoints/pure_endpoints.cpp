#include <array>
#include <optional>
#include <string>

#include "api/advance/acceptable.h"
#include "api/advance/advance_request.h"
#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "api/execution/retime_request.h"
#include "api/vda5050/import.h"
#include "api/vda5050/parse_vda5050_request.h"
#include "api/vda5050/write_orders.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 9> kAdvanceMembers{
    "request", "plans", "at", "commit", "states", "poses", "holds", "goals", "pose_tolerance"};

constexpr std::array<std::string_view, 8> kRetimeMembers{
    "robots", "robot_defaults", "plans", "dependencies", "at", "states", "options", "metadata"};

}  // namespace

Reply advance_endpoint(std::string_view body, const RequestContext& context) {
  const auto next_request = [&](const JsonReader& root, core::Work& stop,
                                const AwaitTurn& await_turn) -> std::optional<std::string> {
    auto request = parse_advance_request(root, context.limits, stop);
    if (!request || !await_turn()) return std::nullopt;
    Moment& moment = request->moment;
    moment.stand_until = standing_time(request->robots, request->executions, moment, stop);
    auto robots = advanced(request->robots, request->executions, moment, stop);
    if (stop.met()) return std::nullopt;
    const Circumstances circumstances = make_acceptable(*request, robots, context.maps, stop);
    if (stop.met()) return std::nullopt;
    return write_advanced(*request, robots, circumstances, stop);
  };
  return pure_endpoint(body, context, kAdvanceMembers, next_request);
}

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

Reply vda5050_endpoint(std::string_view body, const RequestContext& context) {
  const auto orders = [&](const JsonReader& root, core::Work& stop,
                          const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto request = parse_vda5050_request(root, context.limits, stop);
    if (!request || !await_turn()) return std::nullopt;
    return write_orders(*request, stop);
  };
  return pure_endpoint(body, context, kVdaMembers, orders);
}

Reply import_vda5050_endpoint(std::string_view body, const RequestContext& context) {
  const auto states = [&](const JsonReader& root, core::Work& stop,
                          const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto import = parse_vda5050_import(root, context.limits, stop);
    if (!import || !await_turn()) return std::nullopt;
    return write_states(*import, stop);
  };
  return pure_endpoint(body, context, kVdaImportMembers, states);
}

}  // namespace fleetplan::api
