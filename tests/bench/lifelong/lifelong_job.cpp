#include "tests/bench/lifelong/lifelong_job.h"

#include <stdexcept>

namespace fleetplan::bench {

NLOHMANN_JSON_SERIALIZE_ENUM(Strategy, {{Strategy::stop, "stop"},
                                        {Strategy::snapshots, "snapshots"},
                                        {Strategy::committed, "committed"}})

NLOHMANN_JSON_SERIALIZE_ENUM(PlanningClock, {{PlanningClock::wall, "wall"},
                                             {PlanningClock::cpu, "cpu"},
                                             {PlanningClock::none, "none"}})

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
    job.clock = document.at("clock").get<PlanningClock>();
    job.planning = document.at("options");
    return job;
  } catch (const json::exception& error) {
    throw std::runtime_error("not a job: " + line + " (" + error.what() + ")");
  }
}

}  // namespace fleetplan::bench
