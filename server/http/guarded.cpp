#include "server/http/guarded.h"

#include <exception>

#include "api/response/error.h"

namespace fleetplan::server {

api::Reply guarded(const RequestLog& log, const std::string& request_id,
                   const std::function<api::Reply()>& work) {
  std::string what = "an exception of no known type";
  try {
    return work();
  } catch (const std::exception& failure) {
    what = failure.what();
  } catch (...) {  // NOLINT(bugprone-empty-catch): reported below
  }
  log.error(what, request_id);
  return api::problem_reply(api::ErrorCode::internal_error,
                            "A bug in the service; its log has more under this request_id.", request_id);
}

}  // namespace fleetplan::server
