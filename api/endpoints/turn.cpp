#include "api/endpoints/turn.h"

#include "api/response/error.h"

namespace fleetplan::api {

bool take_turn(Turn* turn, const TurnNeed& need, core::Work& work) {
  work.end_reading();
  return turn == nullptr || (turn->request(need) && turn->await());
}

double work_of(std::size_t robots, const std::vector<core::RobotPlan>& plans) {
  std::size_t work = robots;
  for (const core::RobotPlan& plan : plans) work += plan.actions.size();
  return static_cast<double>(work);
}

Reply too_busy(const std::string& request_id) {
  return problem_reply(ErrorCode::overloaded,
                       "All workers are busy, and the request's time budget would be spent in the queue: try "
                       "again later, or with a larger options.time_budget_ms.",
                       request_id);
}

}  // namespace fleetplan::api
