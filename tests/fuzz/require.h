#pragma once

// What must hold for every input of a fuzz target.

#include <cstdio>
#include <cstdlib>
#include <string>

namespace fleetplan::fuzz {

/// Ends the process when it does not hold, which is a finding.
inline void require(bool holds, const char* what, const std::string& detail = {}) {
  if (holds) return;
  std::fprintf(stderr, "%s: %s\n", what, detail.c_str());
  std::abort();
}

}  // namespace fleetplan::fuzz
