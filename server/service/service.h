#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::server {

/// The service behind HTTP. A test uses a stub here and needs no planner.
struct Service {
  using Endpoint = std::function<api::Reply(std::string_view body, const api::RequestContext&)>;
  struct Example {
    std::string name;
    std::string body;  // JSON
  };

  Endpoint plan;                             // run by a planning worker
  Endpoint validate;                         // run by a planning worker
  Endpoint simulate;                         // run by a planning worker, with progress
  Endpoint advance;                          // takes milliseconds, without a turn
  Endpoint dependencies;                     // run by a planning worker
  Endpoint retime;                           // takes milliseconds, without a turn
  Endpoint matrix;                           // run by a planning worker
  Endpoint assign;                           // run by a planning worker
  Endpoint vda5050;                          // takes milliseconds, without a turn
  Endpoint import_vda5050;                   // takes milliseconds, without a turn
  std::function<api::Reply()> example_list;  // GET /v1/examples
  std::function<api::Reply()> openapi;       // GET /v1/openapi.json
  std::vector<Example> examples;
};

/// Returns the service with the planner, by the endpoints of api.
Service planning_service();

}  // namespace fleetplan::server
