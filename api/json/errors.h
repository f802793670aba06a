#pragma once

// Expected failures:
//
// - the faults of a request's content: what they are, where they stand, and the phrases of their details,
// - the errors of the service, from one table,
// - results that are either a value or a failure.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/json_value.h"

namespace fleetplan::api {

/// The outcome of an operation that can fail in an expected way: either its value or its failure, two
/// different types. Ask first:
///
///   auto document = read_json(body, depth);
///   if (!document) return report(document.failure());
///   use(*document);
template <typename Value, typename Failure>
class [[nodiscard]] Result {
 public:
  Result(Value value) : held_(std::in_place_index<0>, std::move(value)) {}        // NOLINT: implicit
  Result(Failure failure) : held_(std::in_place_index<1>, std::move(failure)) {}  // NOLINT: implicit

  explicit operator bool() const { return held_.index() == 0; }
  /// The value; std::bad_variant_access when there is none.
  const Value& operator*() const { return std::get<0>(held_); }
  Value& operator*() { return std::get<0>(held_); }
  const Value* operator->() const { return &std::get<0>(held_); }
  Value* operator->() { return &std::get<0>(held_); }
  /// The failure; std::bad_variant_access when there is none.
  const Failure& failure() const { return std::get<1>(held_); }

 private:
  std::variant<Value, Failure> held_;
};

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

/// The faults of one document, collected while it is read. All are counted. The first kMaxListed in the order
/// of the document are kept. For the others, not even the text is made, so a hostile document costs neither
/// time nor memory.
class FaultList {
 public:
  static constexpr std::size_t kMaxListed = 20;

  /// Adds the fault that `make_fault` returns, or only counts it.
  template <typename MakeFault>
  void add(JsonPlace place, const MakeFault& make_fault) {
    ++count_;
    if (wanted(place)) keep({place, make_fault()});
  }
  /// Adds the faults of another list.
  void add_all(FaultList other);
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

/// Finds where a value stands in the document with this root.
Location locate(const JsonValue& root, const JsonValue& value);

/// Returns one step of a JSON Pointer: "/" and the key, with ~ and / escaped.
std::string pointer_step(std::string_view key);

/// Returns where and why a body is not JSON: line, column and byte (each from 1; columns in bytes), and the
/// text there. `position`: how many bytes had been read when the parser stopped.
std::string explain_malformed(std::string_view body, std::size_t position);

/// Every error of the service. Its row in the table (errors.cpp) gives the HTTP status, `code` and `title`.
enum class ErrorCode {
  malformed_json,          // 400
  too_deep,                // 400
  malformed_request,       // 400, framing
  unauthorized,            // 401
  foreign_origin,          // 403, a page of another origin
  not_found,               // 404
  method_not_allowed,      // 405
  not_acceptable,          // 406
  request_timeout,         // 408, head or body not complete in time
  body_too_large,          // 413
  target_too_long,         // 414, request target
  unsupported_media_type,  // 415
  wrong_host,              // 421, the Host of a request to a service on loopback
  invalid_request,         // 422, with one entry in `errors` for each fault
  check_unfinished,        // 422, a plan that takes longer to check than the budget
  memory_exceeded,         // 422, a request that needs more memory than it is granted
  parse_unfinished,        // 422, a request that takes too long to read
  head_too_large,          // 431, header fields by size or number
  internal_error,          // 500
  overloaded,              // 503, queue full
  draining,                // 503, shutting down
};

/// Ends the detail of a body that is too large. The cause is nearly always its map.
inline constexpr const char* kLargeMapRemedy =
    " A large map is smallest as a PNG, in map.image.png; see GET /v1/limits.";

/// Returns the detail of the 413 for a body of `size` bytes. `size` is a number or "at least" a number.
std::string too_large_body_detail(std::string_view size, std::uint64_t limit);

inline constexpr const char* kDrainingDetail = "The service is shutting down: try another replica.";

struct ErrorRow {
  ErrorCode code;
  int status;
  std::string_view name;         // `code` of the answer
  std::string_view title;        // as in RFC 9110 where the status says it all
  std::string_view description;  // when the error is returned, for the OpenAPI document
};

/// Returns the table, in the order of ErrorCode. api/openapi.json has a response for each status in it.
std::span<const ErrorRow> error_table();

const ErrorRow& row_of(ErrorCode code);
inline int status_of(ErrorCode code) { return row_of(code).status; }
inline std::string_view name_of(ErrorCode code) { return row_of(code).name; }

/// Why a request cannot be read.
struct RequestError {
  ErrorCode code = ErrorCode::invalid_request;
  std::string detail;
  std::vector<Fault> faults;  // the listed faults
  std::size_t faults_total = 0;
};

}  // namespace fleetplan::api
