#pragma once

// The steps that endpoints share: bounded work, the turn, the check of plans, and the replies when a step
// fails.

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/endpoints/request_context.h"
#include "api/json/json_reader.h"
#include "api/request/options.h"
#include "api/request/parse_request.h"
#include "api/response/reply.h"
#include "api/response/write_response.h"
#include "core/execution/dependencies.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/plan/make_plan.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// Runs an endpoint and returns its reply. A Work bounds everything from the first byte of the body to the
/// last byte of the answer's text.
///
/// The request may use `max_plan_memory`. If it needs more, the reply is 422 `memory_exceeded`. If the
/// process lacks the memory that is granted, the reply is 503 `overloaded`. Large memory that is still in use
/// is kept by the reply.
Reply bounded_work(const RequestContext& context, const std::function<Reply(core::Work&)>& endpoint);

/// Returns the 422 for a request that needs more memory than it is granted.
Reply memory_exceeded(const RequestContext& context);

/// Returns the 503 for a request for which the process has no memory at the moment.
Reply out_of_memory(const std::string& request_id);

/// Asks for the turn of a request that has been read, and waits for it. Returns whether it came. Without a
/// Turn, returns true at once.
bool take_turn(Turn* turn, const TurnNeed& need, core::Work& work);

/// Lets other requests have the turn, see Turn::let_others. Returns whether it came back. Without a Turn,
/// returns true at once.
bool share_turn(Turn* turn);

/// Returns the TurnNeed::work of plans that are to be checked or executed.
double work_of(std::size_t robots, const std::vector<core::RobotPlan>& plans);

/// Returns the reply when a computation, such as a check or a simulation, was stopped before it had an
/// answer. `what` begins the sentence: "The plans could not be checked". `fewer` ends it: "poses".
Reply unfinished_reply(std::string_view what, std::string_view fewer, std::chrono::nanoseconds budget,
                       const core::StopCondition& stop, const RequestContext& context);
inline constexpr std::string_view kFewerPlans = "robots or a shorter part of the plans";

/// Waits for the turn of a request whose body has been read and has no fault so far. Returns false if no
/// answer should be made.
using AwaitTurn = std::function<bool()>;

/// Makes the JSON answer to a body from the body's root. Returns none only if it reported faults, if its work
/// was stopped, or if it got no turn.
using MakeAnswer =
    std::function<std::optional<std::string>(const JsonReader&, core::Work&, const AwaitTurn&)>;

/// Returns the reply of an endpoint whose answer depends only on the body. `members`: the members that the
/// body's root may have.
Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make);

/// Makes the reply after plans have been checked, until the stop condition is met.
using AfterCheck =
    std::function<Reply(const ValidateRequest&, const core::VerifyReport&, const core::StopCondition&)>;

/// Reads a body with plans, waits for its turn and checks them. Returns the reply that `after` makes, or the
/// problem.
Reply check_plans(std::string_view body, const RequestContext& context, const AfterCheck& after);

/// The dependencies of a plan that has passed the check, and warnings about them.
struct PlanDependencies {
  std::optional<core::Dependencies> made;  // none: time or memory did not suffice
  std::vector<std::string> warnings;
};

/// Makes the dependencies of plans that have passed a check with this `tolerance` (metres).
PlanDependencies plan_dependencies(const std::vector<core::Robot>& robots,
                                   const std::vector<core::RobotPlan>& plans,
                                   const RequestedDependencies& requested, double tolerance,
                                   bool has_obstacles, const core::StopCondition& stop);

/// Returns the 500 for a plan that the checker rejects.
Reply rejected_plan(const core::VerifyReport& report, const std::string& request_id);

/// Writes the answer with a plan that has been checked. One that the checker rejects is a bug and becomes a
/// 500. If the check was not finished, there is no answer: a plan that is not checked is never returned.
/// `stages`: those before the plan was made. `on_answer`, which may be empty, gets the plan of the answer.
/// `dependencies`: those that are known already; none: they are made if the request asks for them.
Reply plan_answer(const core::CheckedPlan& made, const PlanRequest& request, const std::string& request_id,
                  StageTimes stages, const AnsweredPlan& on_answer,
                  std::optional<PlanDependencies> dependencies = {});

}  // namespace fleetplan::api
