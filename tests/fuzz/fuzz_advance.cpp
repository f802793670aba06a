// Any text as the body of POST /v1/advance: it is refused properly, or the answer can be read as a request to
// plan.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "api/endpoints/endpoints.h"
#include "api/request/parse_request.h"
#include "tests/fuzz/refusals.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/small_limits.h"
#include "tests/fuzz/target.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::fuzz {

namespace TEST_FILE {

using Json = nlohmann::json;

/// Plans from anywhere may leave a robot anywhere and jump, so that the request may have faults.
void require_readable(const std::string& request, const api::Limits& limits) {
  const auto parsed = api::parse_request(request, limits, unbounded_work());
  require(parsed || parsed.failure().code == api::ErrorCode::invalid_request, "the request is not readable",
          request);
}

void try_advance(std::string_view body) {
  api::RequestContext context;
  context.limits = small_limits();
  const api::Reply reply = api::advance_endpoint(body, context);
  if (reply.status != 200) return require_proper_refusal(body, reply);
  const Json next = Json::parse(reply.body, nullptr, false);
  require(next.is_object(), "the answer is not JSON", reply.body);
  require(next["progress"].size() == next["robots"].size(), "the progress is not that of all robots",
          reply.body);
  require(reply.body == api::advance_endpoint(body, context).body, "the answer changes", reply.body);
  require_readable(reply.body, context.limits);
}

void run(Input input) { try_advance(text_of(input)); }

const Target target("advance", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz
