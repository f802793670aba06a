#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::server {

/// The service behind HTTP. Tests can use a stub here, and then need no planner.
struct Service {
  using Endpoint = std::function<api::Reply(std::string_view body, const api::RequestContext&)>;
  struct Example {
    std::string name;
    std::string body;  // JSON
  };

  // Each runs as a job (JobRunner). It waits for its turn once its body has been read and has no fault.
  Endpoint plan;  // with progress
  Endpoint validate;
  Endpoint simulate;  // with progress
  Endpoint margins;   // with progress
  Endpoint advance;   // takes milliseconds once it has its turn
  Endpoint dependencies;
  Endpoint retime;  // takes milliseconds once it has its turn
  Endpoint matrix;
  Endpoint assign;
  Endpoint vda5050;         // takes milliseconds once it has its turn
  Endpoint import_vda5050;  // takes milliseconds once it has its turn

  std::function<api::Reply()> example_list;  // GET /v1/examples
  std::function<api::Reply()> openapi;       // GET /v1/openapi.json
  std::vector<Example> examples;
};

/// Returns the service with the planner, by the endpoints of api.
Service planning_service();

}  // namespace fleetplan::server
