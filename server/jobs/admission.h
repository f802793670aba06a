#pragma once

#include <optional>
#include <string>

#include "api/response/error.h"
#include "server/http/header_fields.h"
#include "server/http/request_head.h"
#include "server/http/static_files.h"
#include "server/ops/settings.h"
#include "server/routes.h"

namespace fleetplan::server {

/// Why a request is not served.
struct Refusal {
  api::ErrorCode code;
  std::string detail;
  HeaderFields fields = {};  // further header fields
};

/// Where a request goes; unknown when there is nothing.
Route route_of(const RequestHead& head, Port port, const StaticFiles& files);

/// Everything for which a request is refused by its head alone, before a byte of the body is read: 401, 404,
/// 405, 406, 413, 415 and 503 while draining. None: it is admitted.
std::optional<Refusal> admission_fault(const RequestHead& head, const Route& route, const Settings& settings,
                                       bool draining);

}  // namespace fleetplan::server
