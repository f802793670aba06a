#pragma once

// A check that fuzz targets make on every input.

#include <cstdio>
#include <cstdlib>
#include <string>

namespace fleetplan::fuzz {

/// Aborts the process if `holds` is false, which libFuzzer reports as a finding.
inline void require(bool holds, const char* what, const std::string& detail = {}) {
  if (holds) return;
  std::fprintf(stderr, "%s: %s\n", what, detail.c_str());
  std::abort();
}

}  // namespace fleetplan::fuzz
