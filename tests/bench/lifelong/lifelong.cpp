#include "tests/bench/lifelong/lifelong.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "api/endpoints/endpoints.h"
#include "tests/bench/lifelong/fleet.h"
#include "tests/bench/lifelong/fleet_request.h"
#include "tests/bench/process.h"

namespace fleetplan::bench {
namespace {

using core::Action;
using nlohmann::json;

/// Seconds until planning is tried again when no robot has a plan.
constexpr double kRetry = 1.0;
/// The period of plans as a share of their horizon, unless a robot is free earlier.
constexpr double kPeriodOfHorizon = 0.25;

struct TimedReply {
  api::Reply reply;
  double seconds = 0.0;
};

/// Seconds of a clock that has any beginning.
double seconds_of(PlanningClock clock) {
  switch (clock) {
    case PlanningClock::wall:
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    case PlanningClock::cpu:
      return thread_cpu_seconds();
    case PlanningClock::none:
      break;
  }
  return 0.0;
}

TimedReply answer_to(const json& request, PlanningClock clock) {
  const std::string body = request.dump();
  const double began = seconds_of(clock);
  api::RequestContext context;
  context.request_id = "bench";
  TimedReply made{api::plan_endpoint(body, context), 0.0};
  made.seconds = seconds_of(clock) - began;
  return made;
}

class Simulation {
 public:
  explicit Simulation(const LifelongJob& job)
      : job_(job),
        map_(map_json(warehouse_map(job.warehouse))),
        fleet_(job.warehouse, job.robots, job.seed) {}

  LifelongResult run(const LifelongProgress& progress) {
    begin();
    while (true) {
      const double next = std::max(now_, next_event());
      advance_to(std::min(next, job_.seconds));
      if (progress) progress(now_, result_);
      if (next >= job_.seconds) break;
      serve();
      replan(job_.planning);
    }
    finish();
    return std::move(result_);
  }

 private:
  bool goes_on() const { return job_.strategy == Strategy::committed; }
  /// How long before a service ends the next plan is asked for.
  double lead() const { return goes_on() ? job_.commit : 0.0; }

  /// The first plan is made before the clock starts.
  void begin() {
    for (Vehicle& vehicle : fleet_.vehicles()) begin_task(vehicle, 0.0);
    for (Vehicle& vehicle : fleet_.vehicles()) vehicle.free_at = Vehicle::kNever;
    json options = job_.planning;
    options["time_budget_ms"] = 60'000;
    const auto reply = answer_to(with_options(options), job_.clock);
    take(reply.reply, 0.0, 0.0);
    result_ = {};
  }

  void begin_task(Vehicle& vehicle, double t) {
    const core::Pose from = vehicle.goal_served ? vehicle.goal : vehicle.rest;
    if (vehicle.goal_served) fleet_.draw_goal(vehicle);
    vehicle.goal_served = true;
    vehicle.task_began = t;
    const json answer =
        json::parse(answer_to(lone_request(map_, vehicle, from), PlanningClock::none).reply.body);
    vehicle.alone = answer.at("plans").at(0).at("cost").get<double>() + job_.service;
  }

  /// When the next plan has to be made.
  double next_event() const {
    double earliest = Vehicle::kNever;
    double latest = 0.0;
    for (const Vehicle& vehicle : fleet_.vehicles()) {
      earliest = std::min(earliest, vehicle.free_at);
      if (vehicle.free_at != Vehicle::kNever) latest = std::max(latest, vehicle.free_at);
    }
    const double event = job_.strategy == Strategy::stop ? latest : earliest;
    const double next = earliest == Vehicle::kNever ? now_ + kRetry : event - lead();
    if (!job_.planning.contains("horizon")) return next;
    const double period = kPeriodOfHorizon * job_.planning.at("horizon").get<double>();
    return std::min(next, planned_at_ + period);
  }

  void advance_to(double t) {
    for (const Vehicle& vehicle : fleet_.vehicles()) {
      result_.moving_seconds += moving_time(vehicle.actions, now_, t);
    }
    now_ = t;
  }

  /// Robots whose service is about to end get a new goal.
  void serve() {
    for (Vehicle& vehicle : fleet_.vehicles()) {
      if (vehicle.free_at > now_ + lead()) continue;
      ++result_.tasks;
      result_.lone_seconds += vehicle.alone;
      result_.service_seconds += job_.service;
      begin_task(vehicle, vehicle.free_at);
      vehicle.free_at = Vehicle::kNever;
    }
  }

  json with_options(const json& options) const {
    json request = fleet_request(map_, fleet_, now_, job_);
    request["options"] = options;
    return request;
  }

  void replan(const json& planning) {
    json options = planning;
    options["time_budget_ms"] = job_.budget_ms;
    const auto [reply, seconds] = answer_to(with_options(options), job_.clock);
    ++result_.replans;
    result_.latencies.push_back(seconds);
    result_.late += seconds * 1000.0 > job_.budget_ms ? 1 : 0;
    const double began = now_;
    planned_at_ = began;
    if (goes_on()) {
      take(reply, began, began);
      const double overdue = seconds - job_.commit;
      if (overdue > 0.0) pause(began + job_.commit, overdue);
      advance_to(began + seconds);
    } else {
      stand_still();
      now_ = began + seconds + job_.halt;
      take(reply, began, now_);
    }
  }

  /// All robots stop where they are. Robots in service remain in it.
  void stand_still() {
    for (Vehicle& vehicle : fleet_.vehicles()) {
      before_.insert_or_assign(vehicle.id, cut(vehicle.actions, now_).after);
      vehicle.rest = vehicle.pose(now_);
      vehicle.actions.clear();
    }
  }

  void pause(double t, double seconds) {
    for (Vehicle& vehicle : fleet_.vehicles()) {
      vehicle.actions = paused(vehicle.actions, t, seconds);
      if (vehicle.free_at != Vehicle::kNever && vehicle.free_at > t) vehicle.free_at += seconds;
    }
  }

  /// From `t` on, the robots execute the answer to a request of the time `asked`. Robots without a plan
  /// execute their commitments. Without an answer, robots that drive go on as planned.
  void take(const api::Reply& reply, double asked, double t) {
    const json answer = json::parse(reply.body);
    std::map<std::string, const json*> plans;
    if (reply.status == 200) {
      for (const json& plan : answer.at("plans")) plans.emplace(plan.at("robot"), &plan);
    } else if (result_.fault.empty()) {
      result_.fault = answer.dump().substr(0, 1000);
    }
    if (reply.status != 200 && goes_on()) return;
    for (Vehicle& vehicle : fleet_.vehicles()) {
      const auto found = plans.find(vehicle.id);
      if (!goes_on() && in_service(vehicle, asked, job_.service)) continue;  // parked until the service ends
      take(vehicle, found == plans.end() ? nullptr : found->second, t);
    }
    before_.clear();
  }

  void take(Vehicle& vehicle, const json* plan, double t) {
    const Actions left = goes_on() ? cut(vehicle.actions, t).after : std::exchange(before_[vehicle.id], {});
    const bool had_plan = vehicle.free_at != Vehicle::kNever;
    vehicle.rest = vehicle.pose(t);
    if (plan == nullptr) {
      ++result_.unplanned;
      vehicle.free_at = Vehicle::kNever;
      vehicle.actions = goes_on() ? cut(vehicle.actions, t + job_.commit).before : Actions{};
    } else {
      const double cost = plan->at("cost");
      vehicle.actions = shifted(actions_of(plan->at("actions")), t);
      vehicle.free_at = t + cost + (goes_on() ? 0.0 : job_.service);
      // It stops at the horizon, and has its goal still ahead.
      if (plan->contains("ends_at")) vehicle.free_at = Vehicle::kNever;
    }
    if (!had_plan || moving_time(left, 0.0, Vehicle::kNever) == 0.0) return;
    ++result_.under_way;
    const double since = left.front().t_start;
    result_.changed += same_motion(shifted(left, -since), shifted(vehicle.actions, -t)) ? 0 : 1;
  }

  /// Tasks that are not finished count as far as their time has passed.
  void finish() {
    result_.robot_seconds = static_cast<double>(job_.robots) * now_;
    for (const Vehicle& vehicle : fleet_.vehicles()) {
      if (vehicle.free_at == Vehicle::kNever) continue;
      const double share = (now_ - vehicle.task_began) / (vehicle.free_at - vehicle.task_began);
      result_.lone_seconds += vehicle.alone * std::clamp(share, 0.0, 1.0);
      result_.service_seconds += std::clamp(now_ - (vehicle.free_at - job_.service), 0.0, job_.service);
    }
  }

  LifelongJob job_;
  json map_;
  Fleet fleet_;
  double now_ = 0.0;
  double planned_at_ = 0.0;                // the last plan was asked for then
  std::map<std::string, Actions> before_;  // what robots did that stand still now
  LifelongResult result_;
};

}  // namespace

LifelongResult simulate(const LifelongJob& job, const LifelongProgress& progress) {
  return Simulation(job).run(progress);
}

}  // namespace fleetplan::bench
