// Any text as the body of the endpoints about the execution of plans: it is refused properly, or served.

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/endpoints/endpoints.h"
#include "tests/fuzz/refusals.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/small_limits.h"
#include "tests/fuzz/target.h"

namespace fleetplan::fuzz {

namespace TEST_FILE {

using Endpoint = api::Reply (*)(std::string_view, const api::RequestContext&);

constexpr std::array<Endpoint, 6> kEndpoints{api::dependencies_endpoint, api::simulate_endpoint,
                                             api::margins_endpoint,      api::retime_endpoint,
                                             api::vda5050_endpoint,      api::import_vda5050_endpoint};

void run(Input input) {
  const std::string_view body = text_of(input);
  api::RequestContext context;
  context.limits = small_limits();
  for (const Endpoint endpoint : kEndpoints) {
    const api::Reply reply = endpoint(body, context);
    if (reply.status != 200) {
      require_proper_refusal(body, reply);
    } else {
      require(nlohmann::json::accept(reply.body), "an answer is not JSON", reply.body);
    }
  }
}

const Target target("execution", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz
