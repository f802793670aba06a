#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/json_writer.h"
#include "api/request/parse_request.h"
#include "api/response/write_response.h"

namespace fleetplan::api {

namespace {

struct Quantile {
  std::string_view name;
  double share;
};
constexpr std::array<Quantile, 6> kQuantiles{
    {{"min", 0.0}, {"p10", 0.1}, {"p50", 0.5}, {"p90", 0.9}, {"p99", 0.99}, {"max", 1.0}}};

/// Writes the mean and the quantiles; null if there are no values. A quantile is the smallest value that is
/// not exceeded in that share of the runs.
void write_distribution(JsonWriter& json, std::string_view name, std::vector<double> values) {
  json.key(name);
  if (values.empty()) {
    json.value(std::optional<double>());
    return;
  }
  const auto count = static_cast<double>(values.size());
  json.begin_object();
  json.member("mean", std::accumulate(values.begin(), values.end(), 0.0) / count);
  auto sorted_until = values.begin();
  for (const Quantile& quantile : kQuantiles) {
    const double rank = std::max(1.0, std::ceil(quantile.share * count));
    const auto place = values.begin() + (static_cast<std::ptrdiff_t>(rank) - 1);
    std::nth_element(sorted_until, place, values.end());
    json.member(quantile.name, *place);
    sorted_until = place;
  }
  json.end_object();
}

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

class SimulationWriter {
 public:
  SimulationWriter(const core::SimulationReport& report, const SimulateRequest& request)
      : report_(report), request_(request) {}

  std::string write(const std::optional<std::string>& trace, const std::string& request_id) {
    const core::SimulationProgress& totals = report_.totals;
    json_.begin_object();
    json_.member("request_id", request_id).member("runs", totals.done);
    json_.member("collision_share", share(totals.collided, totals.done));
    json_.member("deadlock_share", share(totals.deadlocked, totals.done));
    write_planned();
    write_distribution(json_, "flowtime", report_.flowtimes);
    write_distribution(json_, "makespan", report_.makespans);
    write_robots();
    write_collisions();
    write_pairs();
    write_deadlocks();
    if (trace) json_.key("trace").json(*trace);
    json_.key("warnings").begin_array();
    for (const std::string& warning : request_.warnings) json_.value(std::string_view(warning));
    json_.end_array().end_object();
    return json_.take();
  }

 private:
  std::string_view id(std::size_t robot) const { return request_.robots[robot].id; }

  void write_planned() {
    double flowtime = 0.0;
    double makespan = 0.0;
    for (const core::RobotPlan& plan : request_.plans) {
      flowtime += plan.cost;
      makespan = std::max(makespan, plan.cost);
    }
    json_.key("planned").begin_object();
    json_.member("flowtime", flowtime).member("makespan", makespan).end_object();
  }

  void write_robots() {
    json_.key("robots").begin_array();
    for (std::size_t k = 0; k < request_.plans.size(); ++k) {
      const core::RobotPlan& plan = request_.plans[k];
      json_.begin_object().member("robot", id(plan.robot)).member("planned", plan.cost);
      write_distribution(json_, "delay", report_.delays[k]);
      json_.end_object();
    }
    json_.end_array();
  }

  void write_collisions() {
    json_.key("first_collisions").begin_array();
    for (const core::SimulationReport::Numbered& numbered : report_.first_collisions) {
      const core::ExecutedCollision& collision = numbered.collision;
      const core::Position where = request_.frame.to_world(collision.position);
      json_.begin_object().member("run", numbered.run);
      json_.member("with", collision.second ? "robot" : "wall");
      json_.key("robots").begin_array().value(id(collision.first));
      if (collision.second) json_.value(id(*collision.second));
      json_.end_array();
      json_.member("t", collision.t).member("x", where.x()).member("y", where.y());
      json_.member("depth", collision.depth).end_object();
    }
    json_.end_array();
  }

  void write_pairs() {
    json_.key("pairs").begin_array();
    for (const core::SimulationReport::Pair& pair : report_.pairs) {
      json_.begin_object();
      json_.key("robots").begin_array().value(id(pair.first)).value(id(pair.second)).end_array();
      json_.member("runs", pair.runs).member("share", share(pair.runs, report_.totals.done));
      json_.end_object();
    }
    json_.end_array();
  }

  void write_deadlocks() {
    json_.key("deadlocks").begin_array();
    // Bounded: at most SimulationReport::kMostListed runs.
    for (const core::SimulationReport::Deadlock& deadlock : report_.deadlocks) {
      json_.begin_object().member("run", deadlock.run);
      json_.key("robots").begin_array();
      for (const std::size_t plan : deadlock.plans) json_.value(id(request_.plans[plan].robot));
      json_.end_array().end_object();
    }
    json_.end_array();
  }

  const core::SimulationReport& report_;
  const SimulateRequest& request_;
  JsonWriter json_;
};

}  // namespace

std::optional<std::string> write_trace(const core::SimulationTrace& trace, const SimulateRequest& request,
                                       const core::StopCondition& stop) {
  JsonWriter json;
  json.begin_object().member("run", *request.trace).key("plans").begin_array();
  for (std::size_t k = 0; k < request.plans.size(); ++k) {
    if (stop.met()) return std::nullopt;
    const core::Robot& robot = request.robots[request.plans[k].robot];
    const std::vector<core::Action>& actions = trace.actions[k];
    json.begin_object().member("robot", robot.id);
    json.member("cost", actions.empty() ? 0.0 : actions.back().t_end);
    if (!write_actions(json, actions, robot, {}, request.frame.origin, &stop)) return std::nullopt;
    json.end_object();
  }
  json.end_array().end_object();
  return json.take();
}

std::string write_simulation(const core::SimulationReport& report, const SimulateRequest& request,
                             const std::optional<std::string>& trace, const std::string& request_id) {
  return SimulationWriter(report, request).write(trace, request_id);
}

}  // namespace fleetplan::api
