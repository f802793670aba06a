#include "tests/bench/lifelong/lifelong_job.h"

#include <stdexcept>

namespace fleetplan::bench {

NLOHMANN_JSON_SERIALIZE_ENUM(Strategy, {{Strategy::stop, "stop"},
                                        {Strategy::snapshots, "snapshots"},
                                        {Strategy::committed, "committed"}})

LifelongJob parse_lifelong_job(const std::string& line) {
  using nlohmann::json;
  try {
    const json document = json::parse(line);
    LifelongJob job;
    job.name = document.at("name");
    job.strategy = document.at("strategy").get<Strategy>();
    job.warehouse = {document.at("shelves").at(0), document.at("shelves").at(1)};
    job.robots = document.at("robots");
    job.seconds = document.at("seconds");
    job.seed = document.at("seed");
    job.budget_ms = document.at("budget_ms");
    job.commit = document.at("commit");
    job.halt = document.at("halt");
    job.cpu_clock = document.at("clock") == "cpu";
    job.planning = document.at("options");
    return job;
  } catch (const json::exception& error) {
    throw std::runtime_error("not a job: " + line + " (" + error.what() + ")");
  }
}

}  // namespace fleetplan::bench
