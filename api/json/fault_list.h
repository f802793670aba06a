#pragma once

// All faults of one request, gathered while it is read.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/response/error.h"

namespace fleetplan::api {

/// The vocabulary of `errors[].code`.
namespace fault {
inline constexpr const char* kWrongType = "wrong_type";
inline constexpr const char* kMissing = "missing";
inline constexpr const char* kUnknownKey = "unknown_key";
inline constexpr const char* kUnknownValue = "unknown_value";
inline constexpr const char* kUnknownRobot = "unknown_robot";
inline constexpr const char* kDuplicate = "duplicate";
inline constexpr const char* kOutOfRange = "out_of_range";
inline constexpr const char* kEmpty = "empty";
inline constexpr const char* kBadMapRow = "bad_map_row";
inline constexpr const char* kStartInObstacle = "start_in_obstacle";
inline constexpr const char* kGoalInObstacle = "goal_in_obstacle";
inline constexpr const char* kStartsOverlap = "starts_overlap";
inline constexpr const char* kGoalsOverlap = "goals_overlap";
}  // namespace fault

/// Gathers faults and tells them in the order of the document. Those past a generous number are only counted.
class FaultList {
 public:
  /// What is wrong with a value that is there.
  void add(const JsonValue& value, const JsonPath& path, const char* code, std::string detail);
  /// A member that `object` lacks; it is told after those that are there.
  void add_missing(const JsonValue& object, const JsonPath& member, std::string detail);
  /// `place` as of JsonValue::begins().
  void add(std::uint32_t place, Fault fault);

  /// True when what is added now is only counted, so that it need not be told.
  bool full() const;

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  /// The first `most` faults in the order of the document.
  std::vector<Fault> first(std::size_t most) const;

 private:
  struct Placed {
    std::uint32_t place = 0;
    Fault fault;
  };
  std::vector<Placed> placed_;
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;  // of the texts in placed_
};

}  // namespace fleetplan::api
