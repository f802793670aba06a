#include "server/routes.h"

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "server/http/answer/direct_answers.h"
#include "server/http/exchange.h"
#include "server/http/request/content.h"
#include "server/http/route_table.h"
#include "server/http/text.h"
#include "server/ops/metrics.h"
#include "server/ops/process.h"

namespace fleetplan::server {

namespace {

// The handlers of the routes: each delegates and replies.

using api::ErrorCode;
using api::JsonWriter;

/// Returns the policy of the page. Pages of `frame_ancestors` (origins, or *) may show it in a frame.
std::string content_security_policy(const std::vector<std::string>& frame_ancestors) {
  std::string policy =
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
      "'self'; base-uri 'none'; form-action 'none'; frame-ancestors";
  if (frame_ancestors.empty()) policy += " 'none'";
  for (const std::string& origin : frame_ancestors) policy += ' ' + origin;
  return policy;
}

api::Reply json_reply(JsonWriter& json) { return {200, api::kJson, json.take()}; }

api::Reply problem_reply(ErrorCode code, const std::string& detail, const Exchange& exchange) {
  return api::problem_reply(code, detail, exchange.request_id);
}

/// Returns the endpoint's answer as JSON, or as a stream of events if the client prefers that. `last`: the
/// name of the event with the answer.
api::Reply answer_or_events(const Backend& backend, Exchange& exchange, const Service::Endpoint& endpoint,
                            const char* last) {
  if (plan_form(exchange.head.field("accept")) == PlanForm::json) {
    return backend.run_job(exchange, endpoint, nullptr);
  }
  EventStream events(exchange, last);
  api::Reply reply = backend.run_job(exchange, endpoint, &events);
  if (events.begun()) events.end(reply);
  return reply;
}

/// Returns a plan as JSON, or as a stream of events if the client prefers that.
Handler plan(const Backend& backend) {
  return [&backend](Exchange& exchange) {
    return answer_or_events(backend, exchange, backend.service.plan, "plan");
  };
}

/// Returns the figures of a simulation, as JSON or as a stream of events.
Handler simulate(const Backend& backend) {
  return [&backend](Exchange& exchange) {
    return answer_or_events(backend, exchange, backend.service.simulate, "simulation");
  };
}

/// Returns the margins that hold, as JSON or as a stream of events.
Handler margins(const Backend& backend) {
  return [&backend](Exchange& exchange) {
    return answer_or_events(backend, exchange, backend.service.margins, "margins");
  };
}

/// Returns what an endpoint of the backend's service computes, without progress.
Handler compute(const Backend& backend, const Service::Endpoint& endpoint) {
  return [&backend, &endpoint](Exchange& exchange) { return backend.run_job(exchange, endpoint, nullptr); };
}

Handler example_list(const Backend& backend) {
  return [&backend](Exchange& /*exchange*/) { return backend.service.example_list(); };
}

/// Returns the named example, or a 404 that lists the names there are.
Handler example(const Backend& backend) {
  return [&backend](Exchange& exchange) -> api::Reply {
    std::string names;
    for (const auto& example : backend.service.examples) {
      if (example.name == exchange.parameter) return {200, api::kJson, example.body};
      names += (names.empty() ? "" : ", ") + example.name;
    }
    return problem_reply(
        ErrorCode::not_found,
        std::string("There is no example ") + in_quotes(exchange.parameter) + "; there are: " + names + '.',
        exchange);
  };
}

/// Returns the limits of requests, under the names of the settings.
Handler limits(const Backend& backend) {
  return [&settings = backend.settings](Exchange& /*exchange*/) {
    const api::Limits& limits = settings.limits;
    JsonWriter json;
    json.begin_object().member("max_body", limits.max_body).member("max_cells", limits.max_cells);
    json.member("max_robots", limits.max_robots).member("max_depth", limits.max_depth);
    json.member("max_goals", limits.max_goals).member("max_actions", limits.max_actions);
    json.member("max_obstacles", limits.max_obstacles);
    json.member("max_obstacle_entries", limits.max_obstacle_entries);
    json.member("max_zones", limits.max_zones).member("max_zone_corners", limits.max_zone_corners);
    json.member("max_plan_memory", limits.max_plan_memory).member("max_unsent", settings.max_unsent);
    json.member("default_budget_ms", limits.default_budget_ms).member("min_budget_ms", 1);
    json.member("max_budget_ms", limits.max_budget_ms);
    json.member("workers", settings.workers).member("queue", settings.queue).end_object();
    return json_reply(json);
  };
}

Handler openapi(const Backend& backend) {
  return [&backend](Exchange& /*exchange*/) { return backend.service.openapi(); };
}

Handler health() {
  return [](Exchange& /*exchange*/) {
    JsonWriter json;
    json.begin_object().member("status", "ok").member("version", kVersion).end_object();
    return json_reply(json);
  };
}

/// Returns 200, or 503 once the server is shutting down.
Handler readiness(const Backend& backend) {
  return [&backend](Exchange& exchange) {
    if (!backend.is_ready()) {
      return problem_reply(ErrorCode::draining, "The service is shutting down.", exchange);
    }
    JsonWriter json;
    json.begin_object().member("status", "ready").end_object();
    return json_reply(json);
  };
}

/// Returns the metrics in the format of Prometheus.
Handler metrics(const Backend& backend) {
  return [&backend](Exchange& /*exchange*/) -> api::Reply {
    return {200, kMetricsType, backend.metrics_text()};
  };
}

/// Returns a file of the page.
Handler page(const Backend& backend) {
  return [&files = backend.files, policy = content_security_policy(backend.settings.frame_ancestors)](
             Exchange& exchange) -> api::Reply {
    auto file = files.read(exchange.parameter);
    if (!file) {
      return problem_reply(ErrorCode::not_found,
                           files.has_root() ? "The page's folder has no such file."
                                            : "This server has no page: start it with --web-root.",
                           exchange);
    }
    exchange.fields.insert(exchange.fields.end(), {{"ETag", file->etag},
                                                   {"Cache-Control", file->cache_control},
                                                   {"Content-Security-Policy", policy},
                                                   {"Referrer-Policy", "no-referrer"},
                                                   {"Cross-Origin-Opener-Policy", "same-origin"},
                                                   {"Cross-Origin-Resource-Policy", "same-origin"}});
    const bool is_known = exchange.head.field("if-none-match").find(file->etag) != std::string::npos;
    if (is_known) return {304, "", ""};
    return {200, file->content_type, std::move(file->body)};
  };
}

/// Whether the page has a file, by its path.
std::function<bool(std::string_view path)> page_has(const Backend& backend) {
  return [&backend](std::string_view path) { return backend.files.contains(path); };
}

}  // namespace

RouteTable main_routes(const Backend& backend) {
  RouteTable routes;
  routes.post("/v1/plan", plan(backend), {.plans = true, .events = true});
  routes.post("/v1/validate", compute(backend, backend.service.validate));
  routes.post("/v1/simulate", simulate(backend), {.events = true});
  routes.post("/v1/margins", margins(backend), {.events = true});
  routes.post("/v1/advance", compute(backend, backend.service.advance));
  routes.post("/v1/dependencies", compute(backend, backend.service.dependencies));
  routes.post("/v1/retime", compute(backend, backend.service.retime));
  routes.post("/v1/matrix", compute(backend, backend.service.matrix));
  routes.post("/v1/assign", compute(backend, backend.service.assign));
  routes.post("/v1/export/vda5050", compute(backend, backend.service.vda5050));
  routes.post("/v1/import/vda5050", compute(backend, backend.service.import_vda5050));
  routes.get("/v1/examples", example_list(backend));
  routes.get("/v1/examples/{name}", example(backend), {.statuses = {404}});
  routes.get("/v1/limits", limits(backend));
  routes.get("/v1/openapi.json", openapi(backend));
  routes.get("/healthz", health(), {.without_token = true});
  routes.get("/readyz", readiness(backend), {.without_token = true, .statuses = {503}});
  routes.get("/metrics", metrics(backend));
  routes.files("/", page_has(backend), page(backend), {.statuses = {304, 404}});
  return routes;
}

RouteTable admin_routes(const Backend& backend) {
  RouteTable routes;
  routes.get("/healthz", health(), {.without_token = true});
  routes.get("/readyz", readiness(backend), {.without_token = true, .statuses = {503}});
  routes.get("/metrics", metrics(backend));
  return routes;
}

}  // namespace fleetplan::server
