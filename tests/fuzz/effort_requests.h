#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::fuzz {

/// Choices made by the bytes of an input; zeros after its end.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int byte() {
    if (bytes_.empty()) return 0;
    const int value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  /// 0 to `most`, small numbers more often.
  int up_to(int most) {
    const int share = byte();
    return static_cast<int>(static_cast<std::int64_t>(share) * share * most / (255 * 255));
  }
  bool yes() { return byte() % 2 == 1; }
  template <class T, std::size_t N>
  T one_of(const std::array<T, N>& values) {
    return values[static_cast<std::size_t>(byte()) % N];
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

using Endpoint = api::Reply (*)(std::string_view body, const api::RequestContext& context);

/// A valid request with members at the ends of their ranges, and what it is granted.
struct Effort {
  Endpoint endpoint = nullptr;
  bool plans = false;  // the answer is an answer of POST /v1/plan
  std::string body;
  std::size_t robots = 0;
  std::int64_t steps = 0;  // questions of stop conditions until the time is up
  std::size_t memory = 0;  // bytes
};

/// A request to POST /v1/plan: up to 2000 robots, 300,000 cells, extreme radii and speeds.
Effort planning_effort(Choices choices);

/// A request with a plan, to any of the other endpoints: many legs, goals, zones, obstacles, disturbances and
/// dependencies.
Effort execution_effort(Choices choices);

}  // namespace fleetplan::fuzz
