#pragma once

#include <string>

#include "core/model/plan.h"
#include "core/model/problem.h"

namespace fleetplan::api {

/// A picture of a plan as SVG, one unit a metre: blocked cells, zones, and for each robot its disk at the
/// start as a ring, its way, and its disk at the end with its heading. Robots without a plan are gray.
std::string draw_plan(const core::Problem& problem, const core::Plan& plan);

}  // namespace fleetplan::api
