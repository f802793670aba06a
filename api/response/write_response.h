#pragma once

#include <string>
#include <vector>

#include "api/endpoints/request_context.h"
#include "api/request/world_frame.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// When the stages of a request ended.
struct Stages {
  using Time = RequestContext::Clock::time_point;
  Time received;  // last byte of the body in
  Time parsed;
  Time started;  // its turn among others had come
  Time planned;
  Time verified;
};

/// A plan that has passed the check, and what an answer tells beside it.
struct VerifiedPlan {
  const core::Plan& plan;
  const core::VerifyReport& report;
  const std::vector<core::Robot>& robots;
  const WorldFrame& frame;
  const std::vector<std::string>& warnings;
};

/// The answer of POST /v1/plan. Serializing ends with the timings, so that they can tell how long it took.
std::string write_response(const VerifiedPlan& verified, const std::string& request_id, const Stages& stages);

}  // namespace fleetplan::api
