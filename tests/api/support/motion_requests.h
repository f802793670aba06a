#pragma once

// Requests of a fleet in motion for tests to modify.

#include "tests/api/support/requests.h"

namespace fleetplan::api {

inline Json pose(double x, double y, double theta = 0.0) { return {{"x", x}, {"y", y}, {"theta", theta}}; }

inline Json action(const char* type, double begin, double end, const Json& from, const Json& to) {
  return {{"type", type}, {"t_start", begin}, {"t_end", end}, {"from", from}, {"to", to}};
}

/// Robot "a" drives from (0.5, 1.5) to (2.5, 1.5) within 2 s, and waits for 1 s.
inline Json two_actions() {
  return {action("translate", 0.0, 2.0, pose(0.5, 1.5), pose(2.5, 1.5)),
          action("wait", 2.0, 3.0, pose(2.5, 1.5), pose(2.5, 1.5))};
}

/// The two robots that swap ends, of which "a" is committed to drive for 2 s and to wait for 1 s.
inline Json moving_request() {
  Json request = swap_request();
  request["robots"][0]["committed"] = two_actions();
  return request;
}

inline Json entry(double t, double x, double y) { return {{"t", t}, {"x", x}, {"y", y}}; }

/// A person who crosses the hall within 10 s.
inline Json obstacle() {
  return {{"id", "person"}, {"radius", 0.3}, {"motion", {entry(0, 1.5, 0.5), entry(10, 8.5, 0.5)}}};
}

}  // namespace fleetplan::api
