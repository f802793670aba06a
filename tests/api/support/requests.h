#pragma once

// Requests for tests to modify, and their faults.

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "api/request/parse_request.h"
#include "api/response/reply.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {

using Json = nlohmann::ordered_json;

/// Two robots swap the ends of a hall around a wall.
inline Json swap_request() {
  return Json::parse(R"({
    "map": {"rows": [".........", "....#....", "....#....", "........."]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
    "robots": [
      {"id": "a", "start": {"x": 0.5, "y": 1.5, "theta": 0.0}, "goal": {"x": 8.5, "y": 1.5}},
      {"id": "b", "start": {"x": 8.5, "y": 1.5, "theta": 3.0}, "goal": {"x": 0.5, "y": 1.5, "theta": 0.25}}
    ]})");
}

using Faults = std::vector<std::pair<std::string, std::string>>;  // pointer and code

/// The faults of a body that is JSON.
inline std::vector<Fault> faults_of(const std::string& body, const Limits& limits = {}) {
  const auto parsed = parse_request(body, limits, unbounded_work());
  return parsed ? std::vector<Fault>{} : parsed.failure().faults;
}

inline Faults brief(const std::vector<Fault>& faults) {
  Faults brief;
  for (const Fault& fault : faults) brief.emplace_back(fault.pointer, fault.code);
  return brief;
}

inline Faults brief_faults_of(const Json& request, const Limits& limits = {}) {
  return brief(faults_of(request.dump(), limits));
}

/// The detail of the only fault.
inline std::string detail_of(const Json& request, const Limits& limits = {}) {
  const auto faults = faults_of(request.dump(), limits);
  return faults.size() == 1 ? faults.front().detail : std::to_string(faults.size()) + " faults";
}

inline Json json_of(const Reply& reply) { return Json::parse(reply.body); }

/// The faults that a refusal lists.
inline Faults faults_in(const Reply& refusal) {
  Faults faults;
  const Json problem = json_of(refusal);
  for (const Json& fault : problem["errors"]) faults.emplace_back(fault["pointer"], fault["code"]);
  return faults;
}

}  // namespace fleetplan::api
