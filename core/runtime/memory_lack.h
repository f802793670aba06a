#pragma once

#include <cstddef>
#include <cstdint>

namespace fleetplan::core {

/// The number of times that the process lacked memory which nobody's account refused. It tells a job to which
/// std::bad_alloc happens whether it asked for more than it is granted, or should be tried again later.
std::int64_t memory_lacks();

/// Notes that the process has no memory for so many bytes. They do not count if the account of this thread
/// would refuse them anyway.
void note_memory_lack(std::size_t bytes);

}  // namespace fleetplan::core
