#include "api/endpoints/plan_answer.h"

#include <chrono>
#include <utility>

#include "api/response/error.h"
#include "core/verify/tolerances.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

namespace {

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
  const core::OccupancyGrid& grid = request.problem.grid();
  const auto tolerances = core::plan_tolerances(grid, robots, plan.plans);
  const auto report = *core::verify(grid, robots, plan.plans, tolerances, core::StopCondition());
  stages.verified = Stages::Clock::now();
  const PlanOutcome outcome =
      outcome_of(plan, std::chrono::duration<double>(stages.planned - stages.started).count());
  if (!report.valid()) return rejected(outcome, report, request_id);
  std::string text =
      write_response({plan, report, robots, request.frame.origin, request.warnings}, request_id, stages);
  return {200, kJson, std::move(text), {}, outcome};
}

}  // namespace fleetplan::api
