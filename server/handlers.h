#pragma once

// The handlers of the routes: each delegates and replies.

#include <functional>
#include <string_view>

#include "server/http/route_table.h"
#include "server/routes.h"

namespace fleetplan::server {

/// A plan as JSON, or as a stream of events if the client prefers that.
Handler plan(const Backend& backend);

/// The figures of a simulation, likewise.
Handler simulate(const Backend& backend);

/// What an endpoint of the backend's service computes, without progress.
Handler compute(const Backend& backend, const Service::Endpoint& endpoint);

Handler example_list(const Backend& backend);

/// The named example, or a 404 that lists the names there are.
Handler example(const Backend& backend);

/// The limits of requests, under the names of the settings.
Handler limits(const Backend& backend);

Handler openapi(const Backend& backend);

Handler health();

/// 200, or 503 once the server is shutting down.
Handler readiness(const Backend& backend);

/// The format of Prometheus.
Handler metrics(const Backend& backend);

/// A file of the page.
Handler page(const Backend& backend);

/// Whether the page has a file, by its path.
std::function<bool(std::string_view path)> page_has(const Backend& backend);

}  // namespace fleetplan::server
