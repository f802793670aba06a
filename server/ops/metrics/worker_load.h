#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fleetplan::server {

/// Why a job is refused: there is no place; there is none beyond its client's share; or its turn would come
/// too late, or did not come in time.
enum class Refusal { queue_full, share, too_late };
inline constexpr std::size_t kRefusals = 3;

/// The load of the workers, and counts of jobs since the start.
struct WorkerLoad {
  std::size_t waiting = 0;
  std::size_t running = 0;
  std::size_t paused = 0;
  std::array<std::uint64_t, kRefusals> refused{};  // by reason
  std::uint64_t ended_early = 0;                   // improvements that ended because others got their turn
};

}  // namespace fleetplan::server
