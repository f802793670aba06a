#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "api/request/received_robot.h"
#include "core/execution/dependency.h"
#include "core/geometry/moving_obstacle.h"
#include "core/geometry/position.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// When the stages of a request ended.
struct Stages {
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  Time received;  // last byte of the body in
  Time parsed;
  Time started;  // its turn among others had come
  Time planned;
  Time verified;
};

/// A plan that has passed the check, and the other contents of an answer.
struct VerifiedPlan {
  const core::Plan& plan;
  const core::VerifyReport& report;
  const std::vector<core::Robot>& robots;
  const std::vector<core::MovingObstacle>& obstacles;
  const std::vector<ReceivedRobot>& received;  // of each robot
  const core::Position& origin;                // of the map in the world
  const std::vector<std::string>& warnings;
  const std::string& metadata;            // of the request, as JSON; empty: none
  std::optional<double> lattice_spacing;  // metres; none: neither asked for nor chosen
  /// Null: not asked for. Nothing in it: not made in time.
  const std::optional<core::Dependencies>* dependencies = nullptr;
};

/// The answer of POST /v1/plan. Writing ends with the timings, so that they include it.
std::string write_response(const VerifiedPlan& verified, const std::string& request_id, const Stages& stages);

}  // namespace fleetplan::api
