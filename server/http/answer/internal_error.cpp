#include "server/http/answer/internal_error.h"

#include "api/json/error.h"

namespace fleetplan::server {

api::Reply internal_error(const RequestLog& log, const std::string& request_id,
                          const std::exception_ptr& failure) {
  std::string what = "an exception of an unknown type";
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& known) {
    what = known.what();
  } catch (...) {  // NOLINT(bugprone-empty-catch): reported below
  }
  log.error(what, request_id);
  return api::problem_reply(api::ErrorCode::internal_error,
                            "A bug in the service; its log has more under this request_id.", request_id);
}

}  // namespace fleetplan::server
