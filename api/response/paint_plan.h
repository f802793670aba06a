#pragma once

#include <optional>
#include <string>

#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The picture of draw_plan as a PNG, whose longer side has kPaintedSide pixels, without names. Nothing if
/// the stop is met first.
std::optional<std::string> paint_plan(const core::Problem& problem, const core::Plan& plan,
                                      const core::StopCondition& stop);

inline constexpr int kPaintedSide = 1600;

}  // namespace fleetplan::api
