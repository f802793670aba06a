#pragma once

#include <fleetplan/options.h>
#include <fleetplan/problem.h>

#include <optional>
#include <stop_token>
#include <vector>

#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"

namespace fleetplan::library {

/// What is read from a problem; faults of its numbers and lists are added to `faults`.
struct ReadFleet {
  std::vector<core::Robot> robots;
  std::vector<core::MovingObstacle> obstacles;
  std::vector<core::Zone> zones;
  std::vector<Fault> faults;  // the first kMostFaults
};

inline constexpr std::size_t kMostFaults = 20;

ReadFleet read_fleet(const Problem& problem);

std::vector<Fault> faults_of(const Options& options, const Map& map);

/// Whether any robot has committed actions or a previous plan.
bool in_motion(const Problem& problem);

/// A problem for the planner, or its faults. Neither if a stop was requested first.
struct MadeProblem {
  std::optional<core::Problem> problem;
  std::vector<Fault> faults;
};

MadeProblem make_problem(const Problem& problem, const Options& options, const std::stop_token& stop);

}  // namespace fleetplan::library
