// Any text as the body of both endpoints is parsed into a valid problem or rejected with a well-formed
// answer.

#include <nlohmann/json.hpp>
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

void require_within(const api::PlanRequest& request, const api::Limits& limits) {
  using std::chrono::milliseconds;
  const auto& robots = request.problem.robots();
  require(!robots.empty() && robots.size() <= limits.max_robots,
          "the number of robots is outside the limits");
  require(request.problem.grid().cell_count() <= limits.max_cells, "the map is outside the limits");
  require(request.budget >= milliseconds(1) && request.budget <= milliseconds(limits.max_budget_ms),
          "the budget is outside the limits");
  for (const core::Robot& robot : robots) require(!robot.id.empty(), "a robot has no id");
}

/// Returns whether the body is JSON. If not, the same reader rejects it for the other endpoint, too.
bool try_plan_request(std::string_view body, const api::Limits& limits) {
  const auto parsed = api::parse_request(body, limits, unbounded_work());
  if (!parsed) {
    require_proper_refusal(body, api::problem_reply(parsed.failure(), "id"));
    return parsed.failure().code == api::ErrorCode::invalid_request;
  }
  require_within(*parsed, limits);
  require(nlohmann::json::accept(body), "an accepted body is not JSON");
  return true;
}

void try_validate_request(std::string_view body, const api::Limits& limits) {
  api::RequestContext context;
  context.limits = limits;
  const api::Reply reply = api::validate_endpoint(body, context);
  if (reply.status != 200) return require_proper_refusal(body, reply);
  const auto report = nlohmann::json::parse(reply.body, nullptr, false);
  require(report.is_object(), "a report is not JSON", reply.body);
  require(report.at("valid") == report.at("violations").empty(), "a report contradicts itself", reply.body);
}

void run(Input input) {
  const std::string_view body = text_of(input);
  const api::Limits limits = small_limits();
  if (try_plan_request(body, limits)) try_validate_request(body, limits);
}

const Target target("request", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz
