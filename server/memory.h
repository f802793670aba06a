#pragma once

namespace fleetplan::server {

/// Makes the process give memory back that it no longer needs, instead of keeping the most that each of many
/// threads ever took. To be called before any other thread is made.
void keep_memory_small(int workers);

/// Gives back what lies free between what is in use; from time to time. Takes milliseconds at most.
void give_memory_back();

}  // namespace fleetplan::server
