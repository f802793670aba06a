#include "tests/bench/paper_claims.h"

namespace fleetplan::bench {

std::string claimed_success(std::string_view hall, std::size_t robots) {
  if (hall != "empty") return "-";
  if (robots <= kAllSolvedUpTo) return "100 %";
  return robots >= kFewSolvedFrom ? "< 10 %" : "-";
}

}  // namespace fleetplan::bench
