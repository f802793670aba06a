#pragma once

#include <fleetplan/limits.h>
#include <fleetplan/problem.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace fleetplan::library {

/// An inclusive range of numbers.
struct Range {
  double least;
  double most;
  const char* unit;

  bool contains(double value) const { return value >= least && value <= most; }
};

inline constexpr Range kLength{kShortestLength, kLargestExtent, " m"};
inline constexpr Range kLengthOrZero{0.0, kLargestExtent, " m"};
inline constexpr Range kCoordinate{-kFarthestCoordinate, kFarthestCoordinate, " m"};
inline constexpr Range kLinearSpeed{kLeastLinearSpeed, kMostLinearSpeed, " m/s"};
inline constexpr Range kAngularSpeed{kLeastAngularSpeed, kMostAngularSpeed, " rad/s"};
inline constexpr Range kAcceleration{kLeastAcceleration, kMostAcceleration, " per second squared"};
inline constexpr Range kProfileSpeed{0.0, kMostAngularSpeed, ""};
inline constexpr Range kDuration{0.0, kLongestTime, " s"};
inline constexpr Range kAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                              " rad"};

/// Returns the shortest text of a number.
inline std::string number_text(double number) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, result.ptr};
}

/// Returns the place of an item of a list: "robots[3]".
inline std::string item(const std::string& list, std::size_t index) {
  return list + '[' + std::to_string(index) + ']';
}

/// Collects faults, and keeps the first ones of many.
class FaultList {
 public:
  explicit FaultList(std::size_t most) : most_(most) {}

  void add(std::string place, std::string detail) {
    if (listed_.size() < most_) listed_.push_back({std::move(place), std::move(detail)});
  }
  void check(double value, const Range& range, const std::string& place) {
    if (range.contains(value)) return;
    add(place, "The value is " + number_text(value) + "; it must be from " + number_text(range.least) +
                   " to " + number_text(range.most) + range.unit + '.');
  }
  bool empty() const { return listed_.empty(); }
  std::vector<Fault> take() { return std::move(listed_); }

 private:
  std::size_t most_;
  std::vector<Fault> listed_;
};

}  // namespace fleetplan::library
