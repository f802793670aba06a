#include "api/endpoints/advance_endpoint.h"
#include "api/endpoints/examples.h"
#include "api/endpoints/openapi.h"
#include "api/endpoints/plan_endpoint.h"
#include "api/endpoints/validate_endpoint.h"
#include "server/service.h"

namespace fleetplan::server {

Service planning_service() {
  Service service{api::plan_endpoint,     api::validate_endpoint, api::advance_endpoint,
                  api::examples_endpoint, api::openapi_endpoint,  {}};
  for (const auto& example : api::examples()) {
    service.examples.push_back({std::string(example.name), std::string(example.body)});
  }
  return service;
}

}  // namespace fleetplan::server
