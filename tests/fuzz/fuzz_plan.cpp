// Any text as a request to plan, with a tiny budget: every answer is JSON, and /v1/validate accepts every
// plan.

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "api/endpoints/endpoints.h"
#include "tests/fuzz/refusals.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/small_limits.h"
#include "tests/fuzz/target.h"

namespace fleetplan::fuzz {

namespace TEST_FILE {

using Json = nlohmann::json;

api::RequestContext context_now() {
  api::RequestContext context;
  context.request_id = "id";
  context.limits = small_limits();
  return context;
}

/// Requires every robot exactly once in `plans` or `unplanned`.
void require_all_robots(const Json& request, const Json& answer) {
  std::multiset<std::string> expected;
  std::multiset<std::string> answered;
  for (const Json& robot : request.at("robots")) expected.insert(robot.at("id").get<std::string>());
  for (const char* member : {"plans", "unplanned"}) {
    for (const Json& entry : answer.at(member)) answered.insert(entry.at("robot").get<std::string>());
  }
  require(expected == answered, "an answer has other robots than its request", answer.dump());
}

void require_bounded_costs(const Json& answer) {
  for (const Json& plan : answer.at("plans")) {
    require(plan.at("lower_bound") <= plan.at("cost"), "a robot costs less than its bound", answer.dump());
  }
}

void require_proper_answer(const std::string& body, const std::string& reply) {
  const Json answer = Json::parse(reply, nullptr, false);
  require(answer.is_object(), "an answer is not JSON", reply);
  require(answer.at("verified") == true, "an answer is not verified", reply);
  Json merged = Json::parse(body);
  require_all_robots(merged, answer);
  require_bounded_costs(answer);
  merged.update(answer);
  const api::RequestContext usual;  // the default budget is enough even on a slow machine
  const api::Reply verdict = api::validate_endpoint(merged.dump(), usual);
  require(verdict.status == 200, "an answer cannot be validated", verdict.body + reply);
  require(Json::parse(verdict.body).at("valid") == true, "an answer is not valid", verdict.body + reply);
}

void run(Input input) {
  const std::string body(text_of(input));
  const api::Reply reply = api::plan_endpoint(body, context_now());
  if (reply.status == 200) {
    require_proper_answer(body, reply.body);
  } else {
    require_proper_refusal(body, reply);
  }
}

const Target target("plan", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz
