#pragma once

// The faults of a request's content: what they are, where they stand, and the phrases of their details.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_value.h"

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
inline constexpr const char* kDiscontinuity = "discontinuity";  // committed and previous actions
inline constexpr const char* kSpeed = "speed";                  // faster than possible
inline constexpr const char* kProfile = "profile";              // of speed, which does not fit its action
inline constexpr const char* kCommittedCollision = "committed_collision";
inline constexpr const char* kCommittedInZone = "committed_in_zone";
inline constexpr const char* kDependency = "dependency";     // dependencies of other plans
inline constexpr const char* kInvalidPlan = "invalid_plan";  // plans that the check rejects
}  // namespace fault

/// The faults of one document, collected while it is read. All are counted, and the first kMostListed in the
/// order of the document are kept; of the others not even the text is made, so that a hostile document costs
/// neither time nor memory.
class FaultList {
 public:
  static constexpr std::size_t kMostListed = 20;

  /// Adds the fault that `make_fault` returns, or only counts it.
  template <typename MakeFault>
  void add(JsonPlace place, const MakeFault& make_fault) {
    ++count_;
    if (wanted(place)) keep({place, make_fault()});
  }
  /// Counts faults that were found, but not described.
  void count_more(std::size_t faults) { count_ += faults; }

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  std::vector<Fault> listed() const;

 private:
  struct Placed {
    JsonPlace place = 0;
    Fault fault;
    std::size_t bytes() const { return fault.pointer.size() + fault.detail.size(); }
  };
  bool wanted(JsonPlace place) const;
  void keep(Placed placed);

  std::vector<Placed> placed_;  // in the order of the document
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;  // bytes of the texts in placed_
};

/// Returns the text in double quotes, cut to a readable length (at a character of UTF-8).
std::string in_quotes(std::string_view text);

/// Returns the shortest decimal text that reads back as the same double.
std::string number_text(double number);

/// Returns a value in words: `the string "abc"`, `-1`, `an array`.
std::string described(const JsonValue& value);

/// Returns words as a list: `"a", "b", "c"`.
std::string listed(std::span<const std::string_view> words);

/// Returns words as alternatives: `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> words);

/// Returns `; did you mean "radius"?` when one of the words is close enough to the text; otherwise nothing.
std::string suggestion(std::string_view text, std::span<const std::string_view> words);

/// The place of a value in its document.
struct Location {
  std::string pointer;  // RFC 6901: "" for the whole document, "/robots/0/start" below it
  std::string name;     // name of the last step, for messages: the key, "item 3" or "the document"
};

/// Finds a value of the document with this root, by its place in it.
Location locate(const JsonValue& root, const JsonValue& value);

/// Returns one step of a JSON Pointer: "/" and the key, with ~ and / escaped.
std::string pointer_step(std::string_view key);

/// Returns where and why a body is not JSON: line, column and byte (each from 1; columns in bytes) and the
/// text there. `position`: how many bytes had been read when the parser stopped.
std::string explain_malformed(std::string_view body, std::size_t position);

}  // namespace fleetplan::api
