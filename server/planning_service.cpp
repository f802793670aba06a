#include "api/endpoints/advance_endpoint.h"
#include "api/endpoints/dependencies_endpoint.h"
#include "api/endpoints/examples.h"
#include "api/endpoints/openapi.h"
#include "api/endpoints/plan_endpoint.h"
#include "api/endpoints/retime_endpoint.h"
#include "api/endpoints/simulate_endpoint.h"
#include "api/endpoints/validate_endpoint.h"
#include "server/service.h"

namespace fleetplan::server {

Service planning_service() {
  // Listing the examples reads all of their maps, so it is done once.
  const auto list_examples = [list = api::examples_endpoint()] { return list; };
  Service service{api::plan_endpoint,    api::validate_endpoint,     api::simulate_endpoint,
                  api::advance_endpoint, api::dependencies_endpoint, api::retime_endpoint,
                  list_examples,         api::openapi_endpoint,      {}};
  for (const auto& example : api::examples()) {
    service.examples.push_back({std::string(example.name), std::string(example.body)});
  }
  return service;
}

}  // namespace fleetplan::server
