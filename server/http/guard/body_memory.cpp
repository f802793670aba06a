#include "server/http/guard/body_memory.h"

namespace fleetplan::server {

namespace {

/// Reserved at a time, so that a body that arrives in small pieces does not reserve each.
constexpr std::int64_t kStep = 256 * 1024;

std::int64_t in_steps(std::int64_t bytes) { return (bytes + kStep - 1) / kStep * kStep; }

}  // namespace

BodyMemory::BodyMemory(std::uint64_t max_body, std::size_t requests)
    : left_(in_steps(static_cast<std::int64_t>(max_body)) * static_cast<std::int64_t>(requests + 1)) {}

bool BodyMemory::Share::grow_to(std::uint64_t bytes) {
  const auto wanted = static_cast<std::int64_t>(bytes);
  if (bytes <= kSmall || wanted <= held_) return true;
  const std::int64_t more = in_steps(wanted - held_);
  std::int64_t left = memory_.left_;
  do {
    if (left < more) return false;
  } while (!memory_.left_.compare_exchange_weak(left, left - more));
  held_ += more;
  return true;
}

}  // namespace fleetplan::server
