#include "api/endpoints/pure_endpoint.h"

#include <utility>

#include "api/endpoints/within_memory.h"
#include "api/request/parse_body.h"
#include "api/response/error.h"

namespace fleetplan::api {

Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make) {
  return within_memory(context, [&]() -> Reply {
    auto text = parse_body<std::string>(body, context.limits, context.parse_stop(), members, make);
    if (!text) return problem_reply(text.failure(), context.request_id);
    return {200, kJson, std::move(*text)};
  });
}

}  // namespace fleetplan::api
