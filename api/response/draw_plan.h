#pragma once

// Pictures of plans, as SVG and in pixels.

#include <optional>
#include <string>

#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// Returns a picture of a plan as SVG, one unit a metre. It shows blocked cells and zones. For each robot, it
/// shows the disk at the start as a ring, the way, and the disk at the end with its heading. Robots without a
/// plan are gray. Returns none if the stop is met first.
std::optional<std::string> draw_plan(const core::Problem& problem, const core::Plan& plan,
                                     const core::StopCondition& stop);

/// Returns the picture of draw_plan as a PNG without names. The longer side has kPaintedSide pixels. Returns
/// none if the stop is met first.
std::optional<std::string> paint_plan(const core::Problem& problem, const core::Plan& plan,
                                      const core::StopCondition& stop);

inline constexpr int kPaintedSide = 1600;

}  // namespace fleetplan::api
