#include "api/endpoints/check_plans.h"

#include "api/endpoints/bounded_work.h"
#include "api/endpoints/unfinished_reply.h"
#include "api/response/error.h"

namespace fleetplan::api {

namespace {

TurnNeed need_of(const ValidateRequest& request, const core::StopCondition& stop) {
  const double work = work_of(request.robots.size(), request.plans);
  return {TurnNeed::Kind::check, stop, stop.deadline(), work, true};
}

Reply check(std::string_view body, const RequestContext& context, core::Work& work, const AfterCheck& after) {
  const auto request = parse_validate_request(body, context.limits, work);
  if (!request) return problem_reply(request.failure(), context.request_id);
  const core::StopCondition stop = work.before_end();
  const auto unfinished = [&] {
    return unfinished_reply("The plans could not be checked", request->budget, stop, context);
  };
  if (!take_turn(context.turn, need_of(*request, stop), work)) {
    return stop.cancelled() ? unfinished() : too_busy(context.request_id);
  }
  const auto report = core::verify({request->grid, request->robots, request->obstacles, &request->zones},
                                   request->plans, request->rules, stop);
  if (!report) return unfinished();
  return after(*request, *report, stop);
}

}  // namespace

Reply check_plans(std::string_view body, const RequestContext& context, const AfterCheck& after) {
  return bounded_work(context, [&](core::Work& work) { return check(body, context, work, after); });
}

}  // namespace fleetplan::api
