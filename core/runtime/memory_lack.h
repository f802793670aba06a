#pragma once

#include <cstddef>
#include <cstdint>

namespace fleetplan::core {

/// How often the process lacked memory that no account refused. A job that gets std::bad_alloc can tell by it
/// whether it asked for more than it is granted, or should be tried again later.
std::int64_t memory_lacks();

/// Notes that the process has no memory for so many bytes. Does not count if the account of this thread would
/// refuse them anyway.
void note_memory_lack(std::size_t bytes);

}  // namespace fleetplan::core
