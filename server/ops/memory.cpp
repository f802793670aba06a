#include "server/ops/memory.h"

#include <malloc.h>

namespace fleetplan::server {

// The allocator's defaults let resident memory creep for hours under mixed load: it would have eight arenas
// for each CPU, each with the peaks of the connections that happened to meet there, and it raises the size
// from which blocks are given back at once to that of the largest block freed so far. Fixed, the size is
// large enough for the planner's tables to stay, which come and go with each robot.
void keep_memory_small(int workers) {
#ifdef __GLIBC__
  constexpr int kGivenBackAtOnce = 4 << 20;  // bytes
  mallopt(M_ARENA_MAX, workers + 2);
  mallopt(M_MMAP_THRESHOLD, kGivenBackAtOnce);
  mallopt(M_TRIM_THRESHOLD, 2 * kGivenBackAtOnce);
#else
  static_cast<void>(workers);
#endif
}

void give_memory_back() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace fleetplan::server
