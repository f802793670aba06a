#include "api/endpoints/vda5050_endpoint.h"

#include <optional>
#include <string>

#include "api/endpoints/pure_endpoint.h"
#include "api/vda5050/parse_vda5050_request.h"
#include "api/vda5050/write_orders.h"

namespace fleetplan::api {

Reply vda5050_endpoint(std::string_view body, const RequestContext& context) {
  const auto orders = [&](const JsonReader& root, core::Work& stop,
                          const AwaitTurn& await_turn) -> std::optional<std::string> {
    const auto request = parse_vda5050_request(root, context.limits, stop);
    if (!request || !await_turn()) return std::nullopt;
    return write_orders(*request, stop);
  };
  return pure_endpoint(body, context, kVdaMembers, orders);
}

}  // namespace fleetplan::api
