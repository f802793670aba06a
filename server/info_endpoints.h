#pragma once

// The small answers of GET.

#include <string>

#include "api/response/reply.h"
#include "server/ops/settings.h"
#include "server/service.h"

namespace fleetplan::server {

api::Reply health_reply();

/// 200, or 503 when the server is about to end.
api::Reply readiness_reply(bool ready, const std::string& request_id);

/// What a request may ask for, under the names of the settings.
api::Reply limits_reply(const Settings& settings);

/// The named example, or a 404 that lists the names there are.
api::Reply example_reply(const Service& service, const std::string& name, const std::string& request_id);

}  // namespace fleetplan::server
