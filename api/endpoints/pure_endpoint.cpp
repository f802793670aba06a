#include "api/endpoints/pure_endpoint.h"

#include <utility>

#include "api/endpoints/bounded_work.h"
#include "api/request/parse_body.h"
#include "api/response/error.h"

namespace fleetplan::api {

Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make) {
  return bounded_work(context, [&](core::Work& work) -> Reply {
    auto text = parse_body<std::string>(body, context.limits, work, members, make);
    if (!text) return problem_reply(text.failure(), context.request_id);
    return {200, kJson, std::move(*text)};
  });
}

}  // namespace fleetplan::api
