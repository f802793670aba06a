#include "tests/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/bench/alone.h"
#include "tests/bench/median.h"
#include "tests/bench/process.h"

namespace fleetplan::bench {
namespace {

using nlohmann::json;
using Clock = api::RequestContext::Clock;

api::RequestContext context(const MeasureOptions& options) {
  api::RequestContext made;
  made.request_id = "bench";
  made.limits.max_budget_ms = static_cast<std::int64_t>(std::ceil(options.budget * 1000.0));
  // The scaling tables go beyond the default limits of the service.
  made.limits.max_robots = 1'000'000;
  made.limits.max_cells = 1'000'000'000;
  return made;
}

/// The first violation that the checker finds in an answer of POST /v1/plan; empty if none.
std::string fault_of(const std::string& body, const json& answer, const MeasureOptions& options) {
  json both = json::parse(body);
  both.update(answer);
  const api::Reply reply = api::validate_endpoint(both.dump(), context(options));
  const json report = json::parse(reply.body);
  if (reply.status != 200) return report.value("detail", "the check failed");
  if (report.at("valid").get<bool>()) return {};
  return report.at("violations").at(0).at("detail");
}

double seconds_of(const json& answer, const char* step) {
  return answer.at("timings_ms").at(step).get<double>() / 1000.0;
}

Measurement read_answer(const std::string& name, std::size_t robots, const json& answer) {
  Measurement made;
  made.file = name;
  made.robots = robots;
  made.solved = answer.at("status") == "solved";
  made.attempts = answer.at("search").at("attempts");
  made.planned = answer.at("plans").size();
  made.expansions = answer.at("search").at("expansions");
  made.improvements = answer.at("search").at("improvements");
  made.deterministic = answer.at("deterministic");
  made.parse_seconds = seconds_of(answer, "parse");
  made.verify_seconds = seconds_of(answer, "verify");
  made.write_seconds = seconds_of(answer, "serialize");
  if (made.solved) {
    made.flowtime = answer.at("flowtime").get<double>();
    made.makespan = answer.at("makespan").get<double>();
    made.lower_bound = answer.at("lower_bound").at("flowtime").get<double>();
    made.makespan_lower_bound = answer.at("lower_bound").at("makespan").get<double>();
  }
  return made;
}

}  // namespace

Measurement measure(const std::string& name, std::size_t robots, const std::string& body,
                    const MeasureOptions& options) {
  std::vector<double> seconds;
  std::vector<double> cpu_seconds_used;
  std::vector<double> plan_seconds;
  std::size_t memory = 0;
  api::Reply reply;
  json answer;
  for (int run = 0; run < options.repeats; ++run) {
    forget_peak_memory();
    const double cpu_began = thread_cpu_seconds();
    const auto began = Clock::now();
    reply = api::plan_endpoint(body, context(options));
    seconds.push_back(std::chrono::duration<double>(Clock::now() - began).count());
    cpu_seconds_used.push_back(thread_cpu_seconds() - cpu_began);
    memory = std::max(memory, peak_memory());
    answer = json::parse(reply.body);
    if (reply.status == 200) plan_seconds.push_back(seconds_of(answer, "plan"));
  }
  Measurement made;
  if (reply.status == 200) {
    made = read_answer(name, robots, answer);
    made.plan_seconds = median(plan_seconds);
    made.fault = fault_of(body, answer, options);
    if (options.alone) made.alone = plan_alone(body, context(options).limits, options.repeats);
  } else {
    made.file = name;
    made.robots = robots;
    made.fault = answer.value("detail", "no plan");
    for (const json& fault : answer.value("errors", json::array())) {
      made.fault += " " + fault.value("pointer", "") + ": " + fault.value("detail", "");
    }
  }
  made.seconds = median(seconds);
  made.cpu_seconds = median(cpu_seconds_used);
  made.peak_memory = memory;
  return made;
}

}  // namespace fleetplan::bench
