#include "tests/bench/job.h"

#include <cstdint>
#include <stdexcept>

namespace fleetplan::bench {
namespace {

using nlohmann::json;

SeededRecipe parse_workload(const json& workload) {
  return {hall(workload.at("hall"), workload.at("side"), workload.at("robots")),
          workload.at("seed").get<std::uint64_t>()};
}

}  // namespace

Job parse_job(const std::string& line) {
  try {
    const json document = json::parse(line);
    Job job;
    job.name = document.at("name");
    if (document.contains("workload")) {
      job.from = parse_workload(document.at("workload"));
    } else {
      job.from = document.at("file").get<std::string>();
    }
    job.robots = document.at("robots").get<std::vector<std::size_t>>();
    job.planning = document.at("options");
    job.defaults = document.value("robot_defaults", json::object());
    job.measure = {document.at("budget"), document.at("repeats"), document.value("alone", false)};
    return job;
  } catch (const json::exception& error) {
    throw std::runtime_error("not a job: " + line + " (" + error.what() + ")");
  }
}

Instance load(const Job& job) {
  if (const auto* file = std::get_if<std::string>(&job.from)) return read_instance(job.name, *file);
  const auto& [recipe, seed] = std::get<SeededRecipe>(job.from);
  return make_instance(job.name, generate(recipe, seed));
}

}  // namespace fleetplan::bench
