// Any text as the body of POST /v1/matrix and POST /v1/assign. It is refused properly, or the matrix is
// whole, or the answer can be read as a request to plan.

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

api::RequestContext context() {
  api::RequestContext context;
  context.limits = small_limits();
  return context;
}

void try_matrix(std::string_view body) {
  const api::Reply reply = api::matrix_endpoint(body, context());
  if (reply.status != 200) return require_proper_refusal(body, reply);
  const Json answer = Json::parse(reply.body, nullptr, false);
  require(answer.is_object(), "the answer is not JSON", reply.body);
  const Json& seconds = answer["seconds"];
  const Json& metres = answer["metres"];
  require(!seconds.empty() && seconds.size() == metres.size(), "the rows are not whole", reply.body);
  for (std::size_t row = 0; row < seconds.size(); ++row) {
    require(seconds[row].size() == metres[0].size() && metres[row].size() == metres[0].size(),
            "the columns are not whole", reply.body);
    for (std::size_t column = 0; column < seconds[row].size(); ++column) {
      const Json& time = seconds[row][column];
      require(time.is_null() == metres[row][column].is_null(), "a way has one number", reply.body);
      require(time.is_null() || time.get<double>() >= 0.0, "a time is negative", reply.body);
    }
  }
}

/// The tasks may have goals that overlap goals of other robots, so that the request may have faults.
void try_assign(std::string_view body) {
  const api::Reply reply = api::assign_endpoint(body, context());
  if (reply.status != 200) return require_proper_refusal(body, reply);
  const auto parsed = api::parse_request(reply.body, small_limits(), unbounded_work());
  require(parsed || parsed.failure().code == api::ErrorCode::invalid_request, "the request is not readable",
          reply.body);
}

void run(Input input) {
  try_matrix(text_of(input));
  try_assign(text_of(input));
}

const Target target("travel", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz
