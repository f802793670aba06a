#pragma once

#include <vector>

namespace fleetplan::api {

/// Whether and which dependencies the answer is to have.
struct RequestedDependencies {
  bool wanted = false;          // with a plan
  double slack = 0.1;           // seconds, > 0
  std::vector<double> margins;  // by robot: metres, >= 0
};

}  // namespace fleetplan::api
