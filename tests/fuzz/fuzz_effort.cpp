// Requests of all endpoints at the ends of their ranges, with small budgets of steps and memory. The answer
// comes soon after the budget is spent, however small it is. It is a verified plan, or what was asked for, or
// a well-formed rejection.
//
// Time is counted, not measured, so that the same requests fail on every machine. The questions to stop
// conditions are counted. In builds with the preset `count`, basic blocks of the program are counted as well;
// a machine executes some hundred million in a second. There, the blocks between two questions are bounded.
// So every loop is bounded, whether somebody thought of it or not.

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/fuzz/effort_requests.h"
#include "tests/fuzz/refusals.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/target.h"
#include "tests/support/step_limit.h"

namespace fleetplan::fuzz {

namespace {

/// The basic blocks since the last question. All requests of this target run in one thread.
struct Blocks {
  std::int64_t count = 0;
  bool counting = false;  // while an endpoint computes
};

Blocks blocks;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): for the callback below

class Steps final : public support::StepLimit {
 public:
  using StepLimit::StepLimit;
  bool met(bool outlasts) override {
    blocks.count = 0;
    return StepLimit::met(outlasts);
  }
};

}  // namespace

namespace TEST_FILE {

using Json = nlohmann::json;

/// Steps after the last one of the time: each robot may be asked about a few times, and each loop ends.
std::int64_t allowed_lateness(std::size_t robots) { return 500 + 16 * static_cast<std::int64_t>(robots); }

/// All that an answer has for each robot besides its actions.
std::size_t allowed_size(const Json& answer, std::size_t request) {
  std::size_t actions = 0;
  for (const Json& plan : answer.at("plans")) actions += plan.at("actions").size();
  return 4096 + 64 * request + 1024 * actions;
}

void check_plan(const Effort& effort, const api::Reply& reply) {
  const Json answer = Json::parse(reply.body, nullptr, false);
  require(answer.is_object(), "an answer is not JSON", reply.body);
  require(answer.at("verified") == true, "an answer is not verified", reply.body);
  require(answer.at("plans").size() + answer.at("unplanned").size() == effort.robots,
          "an answer has other robots than its request", reply.body);
  require(reply.body.size() <= allowed_size(answer, effort.body.size()),
          "an answer is not linear in its request", std::to_string(reply.body.size()));
}

void check(const Effort& effort) {
  api::RequestContext context;
  context.request_id = "id";
  context.limits.max_plan_memory = effort.memory;
  Steps steps(effort.steps);
  context.early_end = &steps;
  blocks = {0, true};
  const api::Reply reply = effort.endpoint(effort.body, context);
  blocks.counting = false;
  const std::int64_t late = steps.late();
  require(late <= allowed_lateness(effort.robots), "an answer is late", std::to_string(late));
  if (reply.status != 200) return require_proper_refusal(effort.body, reply);
  if (effort.plans) return check_plan(effort, reply);
  require(Json::accept(reply.body), "an answer is not JSON", reply.body);
}

void run(Input input) {
  Choices choices(input);
  check(choices.yes() ? execution_effort(choices) : planning_effort(choices));
}

const Target target("effort", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz

#ifdef FLEETPLAN_COUNT
/// Called by each basic block of a build with -fsanitize-coverage=trace-pc.
extern "C" __attribute__((no_sanitize_coverage)) void __sanitizer_cov_trace_pc() {  // NOLINT
  using fleetplan::fuzz::blocks;
  // A tenth of a second: the longest map is read, copied and indexed in a few linear passes.
  constexpr std::int64_t kMaxBlocks = 40'000'000;
  if (!blocks.counting || ++blocks.count < kMaxBlocks) return;
  std::fputs("a loop asks no stop condition\n", stderr);
  std::abort();  // here, so that a debugger shows the loop
}
#endif
