#include "server/http/guard/body_memory.h"

namespace fleetplan::server {

namespace {

/// Reserved at a time, so that a body that arrives in small pieces does not reserve each.
constexpr std::int64_t kStep = 256 * 1024;
constexpr std::int64_t kSmallStep = 4 * 1024;

std::int64_t in_steps(std::int64_t bytes, std::int64_t step) { return (bytes + step - 1) / step * step; }

bool take(std::atomic<std::int64_t>& from, std::int64_t bytes) {
  std::int64_t left = from;
  do {
    if (left < bytes) return false;
  } while (!from.compare_exchange_weak(left, left - bytes));
  return true;
}

}  // namespace

BodyMemory::BodyMemory(std::uint64_t max_body, std::size_t requests, std::size_t small)
    : left_(in_steps(static_cast<std::int64_t>(max_body), kStep) * static_cast<std::int64_t>(requests + 1)),
      small_left_(static_cast<std::int64_t>(kSmall) * static_cast<std::int64_t>(small)) {}

BodyMemory::Share::~Share() {
  memory_.left_ += held_;
  memory_.small_left_ += held_small_;
}

bool BodyMemory::Share::grow_to(std::uint64_t bytes) {
  const bool is_small = bytes <= kSmall;
  std::int64_t& held = is_small ? held_small_ : held_;
  const auto wanted = static_cast<std::int64_t>(bytes);
  if (wanted <= held) return true;
  const std::int64_t more = in_steps(wanted - held, is_small ? kSmallStep : kStep);
  if (!take(is_small ? memory_.small_left_ : memory_.left_, more)) return false;
  held += more;
  return true;
}

}  // namespace fleetplan::server
