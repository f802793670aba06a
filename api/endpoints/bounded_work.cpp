#include "api/endpoints/bounded_work.h"

#include <cstdint>
#include <memory>
#include <new>

#include "api/json/fault_text.h"
#include "api/response/error.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::api {

namespace {

/// Less is freed at once: within about a millisecond.
constexpr std::int64_t kMuch = 4 << 20;

}  // namespace

Reply bounded_work(const RequestContext& context, const std::function<Reply(core::Work&)>& endpoint) {
  core::Work work({context.stop, context.received_at, context.limits.max_plan_memory, context.cpu_clock});
  try {
    const core::MemoryScope scope(work.memory().get());
    Reply reply = endpoint(work);
    if (work.memory()->used() > kMuch) reply.leftovers = work.memory();
    return reply;
  } catch (const std::bad_alloc&) {
    return memory_exceeded(context);
  }
}

Reply memory_exceeded(const RequestContext& context) {
  const double mebibytes = static_cast<double>(context.limits.max_plan_memory) / (1 << 20);
  return problem_reply(ErrorCode::memory_exceeded,
                       "The request needs more than " + number_text(mebibytes) +
                           " MiB of memory, max_plan_memory of /v1/limits: send fewer robots or a map with "
                           "fewer cells.",
                       context.request_id);
}

}  // namespace fleetplan::api
