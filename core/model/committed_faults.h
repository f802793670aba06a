#pragma once

#include <vector>

#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/zone_maps.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Returns by robot the faults of the kinds committed_collision and committed_in_zone: bare disks that
/// overlap by more than kContactTolerance. Two committed motions are compared while both last, to their own
/// ends. A robot without a goal, or an invalid one, stands at its end for ever. A robot that has a goal but
/// no commitment may leave, so it is in the way of no other. Starts that overlap by no more than the
/// conditions allow may part: until they are clear, such a pair comes no nearer, and neither does such a
/// robot to a wall or a blocked zone. Starts that overlap by more are faults of another kind, and are left
/// out. The list is incomplete if the stop condition is met.
std::vector<ProblemFault> committed_faults(const ZoneMaps& maps, const std::vector<Robot>& robots,
                                           const ProblemConditions& conditions, const StopCondition& stop);

}  // namespace fleetplan::core
