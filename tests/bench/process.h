#pragma once

#include <cstddef>

namespace fleetplan::bench {

/// CPU time of this thread so far.
double thread_cpu_seconds();

/// The most memory that this process has had resident since it was forgotten, or at all, bytes.
std::size_t peak_memory();
/// Gives unused memory back and lets the peak count from now on, where the kernel permits.
void forget_peak_memory();

}  // namespace fleetplan::bench
