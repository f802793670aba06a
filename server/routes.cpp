#include "server/routes.h"

#include "server/handlers.h"

namespace fleetplan::server {

RouteTable main_routes(const Backend& backend) {
  RouteTable routes;
  routes.post("/v1/plan", plan(backend), {.plans = true, .events = true});
  routes.post("/v1/validate", compute(backend, backend.service.validate));
  routes.post("/v1/simulate", simulate(backend), {.events = true});
  routes.post("/v1/advance", compute(backend, backend.service.advance));
  routes.post("/v1/dependencies", compute(backend, backend.service.dependencies));
  routes.post("/v1/retime", compute(backend, backend.service.retime));
  routes.post("/v1/export/vda5050", compute(backend, backend.service.vda5050));
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
