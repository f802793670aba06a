#pragma once

#include <optional>
#include <string>

#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// A picture of a plan as SVG, one unit a metre: blocked cells, zones, and for each robot its disk at the
/// start as a ring, its way, and its disk at the end with its heading. Robots without a plan are gray.
/// Nothing if the stop is met first.
std::optional<std::string> draw_plan(const core::Problem& problem, const core::Plan& plan,
                                     const core::StopCondition& stop);

}  // namespace fleetplan::api
