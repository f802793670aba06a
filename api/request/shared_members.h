#pragma once

// What several members of a request share: the frame of their positions, quotas, unique ids, and what answers
// repeat.

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "core/geometry/position.h"
#include "core/model/action.h"

namespace fleetplan::api {

/// Lists of members, one behind the other.
template <std::size_t... kCounts>
constexpr auto joined(const std::array<std::string_view, kCounts>&... lists) {
  std::array<std::string_view, (kCounts + ...)> all{};
  auto end = all.begin();
  ((end = std::copy(lists.begin(), lists.end(), end)), ...);
  return all;
}

/// The members that say what is planned.
inline constexpr std::array<std::string_view, 7> kFleetMembers{
    "map", "robot_defaults", "robots", "obstacles", "zones", "options", "metadata"};

/// The members that the answers of POST /v1/advance and /v1/assign add to a request, for the program that
/// executes the plans.
inline constexpr std::array<std::string_view, 5> kAddedMembers{"progress", "unavoidable", "unavoidable_total",
                                                               "assigned", "unassigned"};

/// The members that an answer of POST /v1/plan has beside its plans.
inline constexpr std::array<std::string_view, 17> kPlanAnswerMembers{
    "status",      "request_id",   "unplanned",     "flowtime",  "makespan",       "objective_value",
    "lower_bound", "verified",     "min_clearance", "search",    "deterministic",  "timings_ms",
    "warnings",    "dependencies", "tight",         "estimated", "lattice_spacing"};

/// The members of a request of POST /v1/plan. Added members are ignored.
inline constexpr auto kPlanRequestMembers = joined(kFleetMembers, kAddedMembers);

inline bool is_of_an_answer(std::string_view member) {
  return std::find(kAddedMembers.begin(), kAddedMembers.end(), member) != kAddedMembers.end();
}

class GivenPositions;

/// The position of the map in the client's world. The core plans in the map frame, whose origin is the
/// lower-left corner of the map. The axes are the same.
struct WorldFrame {
  core::Position origin{0.0, 0.0};  // origin of the map in the world, metres
  /// Remembers the positions that were given, so that answers repeat them to the last digit. Null: positions
  /// are not remembered.
  GivenPositions* given = nullptr;

  core::Position to_map(const core::Position& world) const;
  core::Position to_world(const core::Position& map) const;
};

/// Positions that a frame would not reproduce to the last digit.
class GivenPositions {
 public:
  void keep(const core::Position& map, const core::Position& world) {
    world_.insert_or_assign({map.x(), map.y()}, world);
  }
  std::optional<core::Position> find(const core::Position& map) const {
    const auto found = world_.find({map.x(), map.y()});
    return found != world_.end() ? std::optional(found->second) : std::nullopt;
  }

 private:
  std::map<std::pair<double, double>, core::Position> world_;  // by the position in the map
};

inline core::Position WorldFrame::to_map(const core::Position& world) const {
  core::Position map = world - origin;
  if (given != nullptr && map + origin != world) given->keep(map, world);
  return map;
}

inline core::Position WorldFrame::to_world(const core::Position& map) const {
  if (given != nullptr) {
    if (const auto kept = given->find(map)) return *kept;
  }
  return map + origin;
}

/// How many things of one kind a request may contain in total, wherever they are.
class Quota {
 public:
  /// A quota of `max` things. `what` names them, in the plural, for the fault.
  Quota(std::size_t max, std::string_view what) : left_(max), max_(max), what_(what) {}

  /// Takes the items of an array from the quota. Returns whether all are within it. Only the first array
  /// beyond the quota is a fault; later arrays are not.
  bool take(const JsonReader& array) { return take(array.size(), array); }
  /// Takes so many items, which come from the value `place`. Returns whether they are within the quota.
  bool take(std::size_t count, const JsonReader& place) {
    if (exceeded_) return false;
    exceeded_ = count > left_;
    if (exceeded_) {
      place.fault(fault::kOutOfRange, "The request has more than " + std::to_string(max_) + " " +
                                          std::string(what_) + ", the maximum of this service; send fewer.");
      return false;
    }
    left_ -= count;
    return true;
  }

  /// The number of things that still fit.
  std::size_t left() const { return exceeded_ ? 0 : left_; }

 private:
  std::size_t left_;
  std::size_t max_;
  std::string_view what_;
  bool exceeded_ = false;
};

/// Reports every id that an earlier robot or obstacle already has.
class UniqueIds {
 public:
  enum class Kind { robot, obstacle };

  /// Checks the id of the robot or obstacle with this index, at its `item`. All robots come before the
  /// obstacles.
  void check(Kind kind, const std::string& id, std::size_t index, const JsonReader& item) {
    if (id.empty()) return;
    const auto [first, is_new] = owner_.emplace(id, Owner{kind, index});
    if (is_new) return;
    item.find("id").fault(fault::kDuplicate, [&, earlier = first->second] {
      const std::string last = std::to_string(index);
      const std::string pair = earlier.kind == kind
                                   ? (kind == Kind::robot ? "Robots " : "Obstacles ") +
                                         std::to_string(earlier.index) + " and " + last
                                   : "Robot " + std::to_string(earlier.index) + " and obstacle " + last;
      return pair + " (from 0) both have the id " + in_quotes(id) + "; ids must be unique.";
    });
  }

 private:
  struct Owner {
    Kind kind;
    std::size_t index;
  };
  std::unordered_map<std::string, Owner> owner_;  // the first owner of each id
};

/// The most bytes of one object of metadata, and of the actions of a goal, written without spaces.
inline constexpr std::size_t kMaxMetadataBytes = 16'384;

/// Reads `metadata` of a request, a robot or a goal: an object that has no meaning here and that the answer
/// repeats. Returns it as JSON text. Returns an empty text if it is absent or has a fault.
std::string parse_metadata(const JsonReader& owner);

/// Reads `actions` of a goal: what the robot does there during its service. They have no meaning here, and
/// the answer repeats them. Returns them as JSON text. Returns an empty text if they are absent or have a
/// fault.
std::string parse_goal_actions(const JsonReader& goal);

/// Returns the list as JSON text. A text that is too long is a fault.
std::string text_of_any_of(const JsonReader& any_of);

/// What answers repeat of a goal, as JSON text. A text is empty if the goal does not have the member.
struct GoalTexts {
  std::string metadata;  // see parse_metadata
  std::string actions;   // see parse_goal_actions
  std::string any_of;    // the poses at one of which it is served

  bool empty() const { return metadata.empty() && actions.empty() && any_of.empty(); }
};

/// The actions of a request as they were received, in the world and with their headings as given. An action
/// is kept only if the core's numbers do not reproduce it. Either the map's origin rounds them, or the action
/// was joined to the previous action.
class ReceivedMotion {
 public:
  /// Keeps an action by its index; indices ascend.
  void keep(std::size_t index, const core::Action& world) { kept_.push_back({index, world}); }

  /// Returns the action as received, or null if the core's numbers reproduce it.
  const core::Action* find(std::size_t index) const {
    const auto found =
        std::lower_bound(kept_.begin(), kept_.end(), index,
                         [](const Kept& kept, std::size_t wanted) { return kept.index < wanted; });
    return found != kept_.end() && found->index == index ? &found->world : nullptr;
  }

 private:
  struct Kept {
    std::size_t index;
    core::Action world;
  };
  std::vector<Kept> kept_;
};

/// What the answer needs to know about a robot of the request beside the core's robot.
struct ReceivedRobot {
  ReceivedMotion committed;
  ReceivedMotion previous;
  bool lists_visits = false;               // its plan tells when each goal is visited
  std::vector<Fault> errors;               // why it is invalid; empty if it is not
  std::string metadata = {};               // of the robot, see parse_metadata
  std::vector<GoalTexts> goal_texts = {};  // by goal, as in ParsedGoals
  /// By goal: the number of the pose of `any_of` where the plan serves the goal; none for a goal without
  /// `any_of`. Shorter if the last goals have none.
  std::vector<std::optional<std::size_t>> choices = {};
  /// By goal: where the plan serves it, in the map frame; none for a goal without tolerance. Shorter if the
  /// last goals have none.
  std::vector<std::optional<core::Position>> places = {};
};

}  // namespace fleetplan::api
