#include "api/endpoints/plan_events.h"

#include "api/json/json_writer.h"

namespace fleetplan::api {

namespace {

void write_simulation(JsonWriter& json, const core::SimulationProgress& simulation) {
  json.member("runs", simulation.runs).member("done", simulation.done);
  json.member("collided", simulation.collided).member("deadlocked", simulation.deadlocked);
}

}  // namespace

std::string write_progress(const PlanProgress& progress, double elapsed_ms) {
  const core::Progress& planner = progress.planner;
  JsonWriter json;
  json.begin_object();
  json.member("elapsed_ms", elapsed_ms);
  if (progress.simulation) {
    write_simulation(json, *progress.simulation);
    json.end_object();
    return json.take();
  }
  json.member("attempt", planner.attempts);
  json.member("planned", planner.planned).member("robots", progress.robots);
  if (planner.best) {
    json.key("best").begin_object();
    json.member("flowtime", planner.best->flowtime).member("makespan", planner.best->makespan);
    json.end_object();
  } else {
    json.member("best", std::optional<double>());
  }
  json.end_object();
  return json.take();
}

}  // namespace fleetplan::api
