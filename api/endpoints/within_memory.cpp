#include "api/endpoints/within_memory.h"

#include <new>

#include "api/json/fault_text.h"
#include "api/response/error.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::api {

Reply within_memory(const RequestContext& context, const std::function<Reply()>& work) {
  core::MemoryAccount account(context.limits.max_plan_memory);
  try {
    const core::MemoryScope scope(&account);
    return work();
  } catch (const std::bad_alloc&) {
    const double mebibytes = static_cast<double>(context.limits.max_plan_memory) / (1 << 20);
    return problem_reply(ErrorCode::memory_exceeded,
                         "The request needs more than " + number_text(mebibytes) +
                             " MiB of memory, max_plan_memory of /v1/limits: send fewer robots or a map with "
                             "fewer cells.",
                         context.request_id);
  }
}

}  // namespace fleetplan::api
