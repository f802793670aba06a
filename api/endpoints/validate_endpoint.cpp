#include "api/endpoints/validate_endpoint.h"

#include "api/endpoints/check_plans.h"
#include "api/response/write_report.h"

namespace fleetplan::api {

Reply validate_endpoint(std::string_view body, const RequestContext& context) {
  return check_plans(
      body, context,
      [](const ValidateRequest& request, const core::VerifyReport& report,
         const core::StopCondition&) -> Reply {
        return {200, kJson, write_report(report, request.robots, request.obstacles, request.zones)};
      });
}

}  // namespace fleetplan::api
