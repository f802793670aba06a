#pragma once

#include <cstddef>

namespace fleetplan::bench {

/// CPU time of this thread so far.
double thread_cpu_seconds();

/// The peak of resident memory of this process since forget_peak_memory(), or since its start, in bytes.
std::size_t peak_memory();
/// Returns unused memory to the system and resets the peak, where the kernel permits.
void forget_peak_memory();

}  // namespace fleetplan::bench
