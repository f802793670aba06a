#pragma once

#include <string>

namespace fleetplan::api {

/// One fault of a request's content.
struct Fault {
  std::string pointer;  // RFC 6901 JSON Pointer to the smallest value that is wrong
  std::string code;     // one of those below
  std::string detail;   // what is wrong and what would be right
};

/// The values of `errors[].code`.
namespace fault {
inline constexpr const char* kWrongType = "wrong_type";
inline constexpr const char* kMissing = "missing";
inline constexpr const char* kUnknownKey = "unknown_key";
inline constexpr const char* kUnknownValue = "unknown_value";
inline constexpr const char* kUnknownRobot = "unknown_robot";
inline constexpr const char* kUnknownObstacle = "unknown_obstacle";
inline constexpr const char* kDuplicate = "duplicate";
inline constexpr const char* kOutOfRange = "out_of_range";
inline constexpr const char* kEmpty = "empty";
inline constexpr const char* kBadMapRow = "bad_map_row";
inline constexpr const char* kBadImage = "bad_image";
inline constexpr const char* kBadMovingAi = "bad_movingai";
inline constexpr const char* kBadPolygon = "bad_polygon";
inline constexpr const char* kWrongSize = "wrong_size";
inline constexpr const char* kStartInObstacle = "start_in_obstacle";
inline constexpr const char* kGoalInObstacle = "goal_in_obstacle";
inline constexpr const char* kStartsOverlap = "starts_overlap";
inline constexpr const char* kGoalsOverlap = "goals_overlap";
inline constexpr const char* kDiscontinuity = "discontinuity";  // of committed and previous actions
inline constexpr const char* kSpeed = "speed";                  // faster than possible
inline constexpr const char* kCommittedCollision = "committed_collision";
inline constexpr const char* kCommittedInZone = "committed_in_zone";
inline constexpr const char* kDependency = "dependency";     // of other plans
inline constexpr const char* kInvalidPlan = "invalid_plan";  // plans that the check rejects
}  // namespace fault

}  // namespace fleetplan::api
