#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/bench/lifelong/warehouse.h"

namespace fleetplan::bench {

/// How a running fleet is planned.
enum class Strategy {
  stop,       // when all robots are at rest
  snapshots,  // when a robot is free; all others stop where they are, and have no memory of their plans
  committed,  // when a robot is free; the others go on meanwhile, and their plans are known
};

/// What passes on the simulated clock while a plan is made.
enum class PlanningClock {
  wall,  // the time that planning takes
  cpu,   // its CPU time, as if nothing else ran
  none,  // nothing, so that the simulation is the same on every machine
};

/// A running warehouse to simulate.
struct LifelongJob {
  std::string name;
  Strategy strategy = Strategy::committed;
  Warehouse warehouse;
  std::size_t robots = 40;
  double seconds = 3600.0;  // of the simulated clock
  std::uint64_t seed = 1;
  int budget_ms = 100;
  double commit = 0.1;   // seconds that robots go on while a plan is made; `committed` only
  double halt = 0.0;     // seconds that robots take to stop and restart; `snapshots` only
  double service = 2.0;  // seconds at every goal
  PlanningClock clock = PlanningClock::wall;
  nlohmann::json planning = nlohmann::json::object();  // options of the requests
};

/// Reads a job from one line of JSON; throws std::runtime_error if it is none:
///
///   {"name": "committed", "strategy": "committed", "shelves": [3, 8], "robots": 40, "seconds": 3600, "seed":
///   1,
///    "budget_ms": 100, "commit": 0.1, "halt": 0, "clock": "wall", "options": {}}
LifelongJob parse_lifelong_job(const std::string& line);

}  // namespace fleetplan::bench
