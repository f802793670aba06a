#include "api/endpoints/request_context.h"

#include <algorithm>
#include <string>
#include <utility>

#include "api/json/json_writer.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::api {

namespace {

void write_simulation(JsonWriter& json, const core::SimulationProgress& simulation) {
  json.member("runs", simulation.runs).member("done", simulation.done);
  json.member("collided", simulation.collided).member("deadlocked", simulation.deadlocked);
}

void write_margins(JsonWriter& json, const core::MarginProgress& margins) {
  json.member("candidate", margins.candidate).member("candidates", margins.candidates);
  json.member("stage", margins.stage == core::MarginProgress::Stage::plan ? "plan" : "execute");
  json.member("runs", margins.runs).member("bad", margins.bad);
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
  if (progress.margins) {
    write_margins(json, *progress.margins);
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

ProgressReporter::ProgressReporter(PlanEvents& events, std::size_t robots, Clock::time_point deadline,
                                   MakeAnswer make_answer)
    : events_(events), robots_(robots), deadline_(deadline), make_answer_(std::move(make_answer)) {}

void ProgressReporter::progressed(const core::Progress& progress) { events_.progress({robots_, progress}); }

bool ProgressReporter::wants_plan() {
  if (!events_.wants_incumbents()) return false;
  const auto now = Clock::now();
  return !rejection_ && now >= next_ && now < deadline_ - kQuietEnd;
}

void ProgressReporter::show(const core::CheckedPlan& plan) {
  const auto begin = Clock::now();
  Reply reply = make_answer_(plan);
  if (reply.status == 200) {
    const core::MemoryScope not_counted(nullptr);  // other threads free the copy
    events_.incumbent(std::string(reply.body));
  } else {
    rejection_ = std::move(reply);
  }
  const auto end = Clock::now();
  next_ = end + std::max<Clock::duration>(kLeastPause, kLeastPauseFactor * (end - begin));
}

}  // namespace fleetplan::api
