#include "server/info_endpoints.h"

#include <nlohmann/json.hpp>

#include "api/response/error.h"
#include "server/http/text.h"
#include "server/ops/version.h"

namespace fleetplan::server {

namespace {

using Json = nlohmann::ordered_json;

api::Reply json_reply(const Json& json) { return {200, api::kJson, json.dump()}; }

}  // namespace

api::Reply health_reply() { return json_reply({{"status", "ok"}, {"version", kVersion}}); }

api::Reply readiness_reply(bool ready, const std::string& request_id) {
  if (ready) return json_reply({{"status", "ready"}});
  return api::problem_reply(api::ErrorCode::draining, "The service is shutting down.", request_id);
}

api::Reply limits_reply(const Settings& settings) {
  const api::Limits& limits = settings.limits;
  return json_reply({{"max_body", limits.max_body},
                     {"max_cells", limits.max_cells},
                     {"max_robots", limits.max_robots},
                     {"max_depth", limits.max_depth},
                     {"default_budget_ms", limits.default_budget_ms},
                     {"min_budget_ms", 1},
                     {"max_budget_ms", limits.max_budget_ms},
                     {"workers", settings.workers},
                     {"queue", settings.queue}});
}

api::Reply example_reply(const Service& service, const std::string& name, const std::string& request_id) {
  std::string names;
  for (const auto& example : service.examples) {
    if (example.name == name) return {200, api::kJson, example.body};
    names += (names.empty() ? "" : ", ") + example.name;
  }
  return api::problem_reply(
      api::ErrorCode::not_found,
      std::string("There is no example ") + in_quotes(name) + "; there are: " + names + '.', request_id);
}

}  // namespace fleetplan::server
