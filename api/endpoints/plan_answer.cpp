#include "api/endpoints/plan_answer.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "api/response/error.h"
#include "core/geometry/tolerance.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

namespace {

/// How far off a plan may be: twice the contact that is allowed, as the search and the checker round in
/// different ways, and what doubles lose in coordinates of the map's size and times as long as the plan's
/// (64 ulp, as both add up many numbers).
double check_tolerance(const core::Problem& problem, const core::Plan& plan) {
  double fastest = 0.0;
  for (const core::Robot& robot : problem.robots()) {
    fastest = std::max({fastest, robot.linear_speed, robot.angular_speed});
  }
  const double extent = std::max(problem.grid().width(), problem.grid().height());
  const double horizon = plan.objectives.makespan * std::max(1.0, fastest);
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  return 2.0 * core::kContactTolerance + kRounding * std::max(extent, horizon);
}

/// The 500 for a plan that the checker rejects.
Reply rejected(PlanOutcome outcome, const core::VerifyReport& report, const std::string& request_id) {
  Reply reply =
      problem_reply(ErrorCode::internal_error,
                    "The planner made a plan that the checker rejects (" + report.violations.front().detail +
                        "), so it is not returned. This is a bug of the service, not of the request.",
                    request_id);
  outcome.status = PlanOutcome::Status::refused;
  reply.outcome = outcome;
  return reply;
}

}  // namespace

Reply plan_answer(const core::Plan& plan, const PlanRequest& request, const std::string& request_id,
                  Stages stages) {
  stages.planned = Stages::Clock::now();
  const auto& robots = request.problem.robots();
  const auto report =
      core::verify(request.problem.grid(), robots, plan.plans, check_tolerance(request.problem, plan));
  stages.verified = Stages::Clock::now();
  const PlanOutcome outcome =
      outcome_of(plan, std::chrono::duration<double>(stages.planned - stages.started).count());
  if (!report.valid()) return rejected(outcome, report, request_id);
  std::string text =
      write_response({plan, report, robots, request.frame.origin, request.warnings}, request_id, stages);
  return {200, kJson, std::move(text), {}, outcome};
}

}  // namespace fleetplan::api
