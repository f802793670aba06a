#pragma once

#include "server/routes.h"

namespace fleetplan::server {

/// The routes of the main port, without a server.
struct DeclaredRoutes {
  Settings settings;
  Service service;
  StaticFiles files{""};
  Backend backend{settings, service, files};
  RouteTable table = main_routes(backend);
};

}  // namespace fleetplan::server
