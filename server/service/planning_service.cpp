#include "api/endpoints/endpoints.h"
#include "server/service/service.h"

namespace fleetplan::server {

Service planning_service() {
  // Listing the examples reads all of their maps. So it is done once, and only when a client asks for it.
  const auto list_examples = [] {
    static const api::Reply list = api::examples_endpoint();
    return list;
  };
  Service service{.plan = api::plan_endpoint,
                  .validate = api::validate_endpoint,
                  .simulate = api::simulate_endpoint,
                  .margins = api::margins_endpoint,
                  .advance = api::advance_endpoint,
                  .dependencies = api::dependencies_endpoint,
                  .retime = api::retime_endpoint,
                  .matrix = api::matrix_endpoint,
                  .assign = api::assign_endpoint,
                  .vda5050 = api::vda5050_endpoint,
                  .import_vda5050 = api::import_vda5050_endpoint,
                  .example_list = list_examples,
                  .openapi = api::openapi_endpoint,
                  .examples = {}};
  for (const auto& example : api::examples()) {
    service.examples.push_back({std::string(example.name), std::string(example.body)});
  }
  return service;
}

}  // namespace fleetplan::server
