#include "server/body_memory.h"

namespace fleetplan::server {

namespace {

/// Taken at a time, so that a body that comes in small pieces does not ask for each.
constexpr std::int64_t kStep = 256 * 1024;

}  // namespace

bool BodyMemory::Share::grow_to(std::uint64_t bytes) {
  const auto wanted = static_cast<std::int64_t>(bytes);
  if (bytes <= kSmall || wanted <= held_) return true;
  const std::int64_t more = (wanted - held_ + kStep - 1) / kStep * kStep;
  if (memory_.left_.fetch_sub(more) < more) {
    memory_.left_ += more;
    return false;
  }
  held_ += more;
  return true;
}

}  // namespace fleetplan::server
