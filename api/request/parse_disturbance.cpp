#include "api/request/parse_disturbance.h"

#include <array>
#include <string_view>

#include "api/json/faults.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 5> kDisturbanceMembers{"speed", "turn", "stops", "start_delay",
                                                              "cross_track"};
constexpr std::array<std::string_view, 2> kRangeMembers{"min", "max"};
constexpr std::array<std::string_view, 2> kStopsMembers{"rate_per_hour", "mean_s"};
constexpr std::array<std::string_view, 2> kCrossTrackMembers{"sigma", "correlation_length"};

constexpr Range kFactor{1e-3, 1e3, "times the planned speed"};
constexpr double kLongestDelay = 1e6;  // seconds, eleven days
constexpr Range kDelay{0.0, kLongestDelay, "seconds"};
/// Ten a second: more would not let a robot move.
constexpr Range kStopsRate{0.0, 36'000.0, "stops in an hour of motion"};

core::UniformRange parse_range(const JsonReader& member, const Range& allowed,
                               const core::UniformRange& absent) {
  const JsonReader json = member.object(kRangeMembers);
  if (!json) return absent;
  const auto min = json.require("min").number(allowed);
  const auto max = json.require("max").number(allowed);
  if (!min || !max) return absent;
  if (*max < *min) {
    json.find("max").fault(fault::kOutOfRange, "max is " + number_text(*max) + ", less than min, " +
                                                   number_text(*min) + "; it must be at least min.");
  }
  return {*min, *max};
}

core::Disturbance::Stops parse_stops(const JsonReader& member) {
  const JsonReader json = member.object(kStopsMembers);
  if (!json) return {};
  return {json.require("rate_per_hour").number(kStopsRate).value_or(0.0),
          json.require("mean_s").number(kDelay).value_or(0.0)};
}

core::Disturbance::CrossTrack parse_cross_track(const JsonReader& member) {
  const JsonReader json = member.object(kCrossTrackMembers);
  if (!json) return {};
  return {json.require("sigma").number(kLengthOrZero).value_or(0.0),
          json.require("correlation_length").number(kLength).value_or(1.0)};
}

}  // namespace

core::Disturbance parse_disturbance(const JsonReader& member) {
  core::Disturbance disturbance;
  const JsonReader json = member.object(kDisturbanceMembers);
  if (!json) return disturbance;
  disturbance.speed = parse_range(json.find("speed"), kFactor, disturbance.speed);
  disturbance.turn = parse_range(json.find("turn"), kFactor, disturbance.turn);
  disturbance.stops = parse_stops(json.find("stops"));
  disturbance.start_delay = parse_range(json.find("start_delay"), kDelay, disturbance.start_delay);
  disturbance.cross_track = parse_cross_track(json.find("cross_track"));
  return disturbance;
}

}  // namespace fleetplan::api
