#pragma once

#include <optional>

#include "core/motion.h"

namespace fleetplan::core {

/// A lower bound of the cost of a robot that may reverse and gets `distance` metres (> 0) in a direction,
/// from one heading to another one (none: any), seconds. Obstacles and waits are left out. The robot need not
/// turn into the direction: it may go forwards and backwards beside it, on a longer way. docs/method.md,
/// Lemma 4.
double reverse_bound(double distance, double direction, std::optional<double> from_heading,
                     std::optional<double> to_heading, const Motion& motion);

}  // namespace fleetplan::core
