// Answers requests without a server. Reads lines of {"path": "/v1/plan", "body": {...}} from stdin and writes
// the body of each answer as a line to stdout. scripts/bench --lab and --same build and use this.

#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "api/endpoints/endpoints.h"

namespace fleetplan::bench {
namespace {

using Endpoint = std::function<api::Reply(std::string_view, const api::RequestContext&)>;

const std::map<std::string, Endpoint, std::less<>>& endpoints() {
  static const std::map<std::string, Endpoint, std::less<>> all{
      {"/v1/plan", api::plan_endpoint},
      {"/v1/validate", api::validate_endpoint},
      {"/v1/simulate", api::simulate_endpoint},
      {"/v1/advance", api::advance_endpoint},
      {"/v1/dependencies", api::dependencies_endpoint},
      {"/v1/retime", api::retime_endpoint},
      {"/v1/matrix", api::matrix_endpoint},
      {"/v1/assign", api::assign_endpoint},
      {"/v1/export/vda5050", api::vda5050_endpoint},
      {"/v1/import/vda5050", api::import_vda5050_endpoint},
  };
  return all;
}

std::string answer(const std::string& line) {
  const auto request = nlohmann::json::parse(line);
  const std::string path = request.at("path");
  const auto endpoint = endpoints().find(path);
  if (endpoint == endpoints().end()) throw std::runtime_error("there is no " + path + " here");
  api::RequestContext context;
  context.request_id = "bench";
  return endpoint->second(request.at("body").dump(), context).body;
}

}  // namespace
}  // namespace fleetplan::bench

int main() {
  try {
    for (std::string line; std::getline(std::cin, line);) {
      std::cout << fleetplan::bench::answer(line) << '\n' << std::flush;
    }
  } catch (const std::exception& error) {
    std::cerr << "fleetplan_ask: " << error.what() << '\n';
    return 1;
  }
}
