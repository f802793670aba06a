#pragma once

#include "core/model/plan_options.h"
#include "core/model/problem.h"

namespace fleetplan::core {

/// Metres between the vertices of the lattice that robots are planned on: as the options ask. By default, the
/// map's resolution; where that is at most a quarter of the smallest radius, its largest odd multiple up to
/// this radius, so that vertices are centres of cells as well.
double lattice_spacing(const Problem& problem, const PlanOptions& options);

}  // namespace fleetplan::core
