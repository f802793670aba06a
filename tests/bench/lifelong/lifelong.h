#pragma once

#include <functional>

#include "tests/bench/lifelong/lifelong_job.h"
#include "tests/bench/lifelong/lifelong_result.h"

namespace fleetplan::bench {

/// Seconds of simulated time that are done, and of what.
using LifelongProgress = std::function<void(double seconds, const LifelongResult& so_far)>;

/// Simulates a warehouse: a robot that has been served at its goal gets a new one, drawn at random. The
/// robots execute their plans exactly. Planning runs in this thread as a worker of the service does it
/// (parse, plan, verify, write), and its time passes on the simulated clock:
///
/// `stop`, `snapshots`: the robots stand still meanwhile.
/// `committed`: they go on, for `commit` seconds at most. Plans are made so early that they are there when
/// a service ends.
LifelongResult simulate(const LifelongJob& job, const LifelongProgress& progress = {});

}  // namespace fleetplan::bench
