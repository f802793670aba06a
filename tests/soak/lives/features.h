#pragma once

// What a round of a life has of what requests may have, and how often any two of these have met.

#include <array>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/api/support/requests.h"

namespace fleetplan::api {

inline constexpr std::array<std::string_view, 26> kFeatures{
    "origin",      "loads",     "any_of",   "idle",       "accelerations", "releases", "holds",
    "commitments", "previous",  "zones",    "obstacles",  "services",      "times",    "reverse",
    "vicinity",    "inflation", "horizon",  "new goals",  "measured",      "reported", "radii",
    "spacing",     "lattice",   "stopping", "added wait", "priorities"};

/// The features of a request that is planned, and then advanced by this body.
inline std::set<std::string_view> features_of(const Json& request, const Json& body) {
  std::set<std::string_view> found;
  const auto note = [&](std::string_view feature, bool is_there) {
    if (is_there) found.insert(feature);
  };
  const Json options = request.value("options", Json::object());
  const Json& map = request.at("map");
  note("origin",
       map.contains("origin") && (map.at("origin").at("x") != 0.0 || map.at("origin").at("y") != 0.0));
  note("zones", !request.value("zones", Json::array()).empty());
  note("obstacles", !request.value("obstacles", Json::array()).empty());
  note("horizon", options.contains("horizon"));
  note("inflation", options.value("inflation", 0.0) > 0.0);
  note("added wait", options.value("wait_before_move", 0.0) > 0.0);
  note("spacing", options.contains("lattice_spacing"));
  note("lattice", options.value("connectivity", 8) != 8 || !options.value("any_angle", true));
  note("priorities", options.value("priority", "shortest_first") != "shortest_first");
  std::set<double> radii;
  for (const Json& robot : request.at("robots")) {
    radii.insert(robot.value("radius", 0.0));
    note("idle", robot.contains("idle"));
    note("reverse", robot.value("may_reverse", false));
    note("vicinity", robot.value("vicinity", 0.0) > 0.0);
    note("stopping", robot.value("stop_distance", 0.0) > 0.0);
    note("accelerations", robot.contains("linear_acceleration") || robot.contains("angular_acceleration"));
    note("commitments", robot.contains("committed"));
    note("previous", robot.contains("previous"));
    Json goals = robot.value("goals", Json::array());
    if (robot.contains("goal")) goals.push_back(robot.at("goal"));
    for (const Json& goal : goals) {
      note("any_of", goal.contains("any_of"));
      note("services", goal.contains("service"));
      note("times", goal.contains("not_before") || goal.contains("due"));
      for (const char* load : {"radius_after", "linear_speed_after", "linear_acceleration_after"}) {
        note("loads", goal.contains(load));
      }
    }
  }
  note("radii", radii.size() > 1);
  note("holds", body.contains("holds"));
  note("new goals", body.contains("goals"));
  note("measured", body.contains("poses"));
  note("reported", body.contains("states"));
  for (const Json& state : body.value("states", Json::array())) note("releases", state.contains("released"));
  return found;
}

/// How often any two features have met.
class Meetings {
 public:
  void add(const std::set<std::string_view>& features) {
    for (std::size_t a = 0; a < kFeatures.size(); ++a) {
      if (!features.contains(kFeatures[a])) continue;
      for (std::size_t b = 0; b <= a; ++b) counts_[a][b] += features.contains(kFeatures[b]) ? 1 : 0;
    }
  }

  void print() const {
    std::cout << "rounds in which two features have met:\n";
    for (std::size_t a = 0; a < kFeatures.size(); ++a) {
      std::cout << std::setw(13) << kFeatures[a];
      for (std::size_t b = 0; b <= a; ++b) std::cout << ' ' << std::setw(5) << counts_[a][b];
      std::cout << '\n';
    }
  }

  /// The pairs that have met less often than that.
  std::vector<std::string> rarer_than(std::uint64_t least) const {
    std::vector<std::string> rare;
    for (std::size_t a = 0; a < kFeatures.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        if (counts_[a][b] >= least) continue;
        rare.push_back(std::string(kFeatures[a]) + " and " + std::string(kFeatures[b]) + ": " +
                       std::to_string(counts_[a][b]));
      }
    }
    return rare;
  }

 private:
  std::array<std::array<std::uint64_t, kFeatures.size()>, kFeatures.size()> counts_{};
};

}  // namespace fleetplan::api
