#pragma once

// The front door: every route of the service with its method, path and handler.

#include <functional>
#include <string>

#include "api/endpoints/request_context.h"
#include "server/http/route_table.h"
#include "server/http/static_files.h"
#include "server/ops/settings.h"
#include "server/service/service.h"

namespace fleetplan::server {

/// The objects and functions that the handlers delegate to.
struct Backend {
  const Settings& settings;
  const Service& service;
  const StaticFiles& files;

  /// Runs a job with the body of the exchange, see JobRunner::run.
  std::function<api::Reply(Exchange&, const Service::Endpoint&, api::PlanEvents*)> run_job = {};
  std::function<bool()> is_ready = {};
  std::function<std::string()> metrics_text = {};
};

/// Returns the routes of the main port. The backend must outlive the routes, here and below.
RouteTable main_routes(const Backend& backend);

/// Returns the routes of the admin port, which are some of the main port's routes.
RouteTable admin_routes(const Backend& backend);

}  // namespace fleetplan::server
