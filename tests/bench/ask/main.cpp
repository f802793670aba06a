// Answers requests without a server: reads lines of {"path": "/v1/plan", "body": {...}} from stdin and writes
// the body of each answer as a line to stdout. scripts/bench --lab builds and uses this.

#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "api/endpoints/endpoints.h"

namespace fleetplan::bench {
namespace {

std::string answer(const std::string& line) {
  const auto request = nlohmann::json::parse(line);
  const std::string path = request.at("path");
  const std::string body = request.at("body").dump();
  api::RequestContext context;
  context.request_id = "bench";
  if (path == "/v1/plan") return api::plan_endpoint(body, context).body;
  if (path == "/v1/simulate") return api::simulate_endpoint(body, context).body;
  throw std::runtime_error("there is no " + path + " here");
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
