#include "api/request/fleet/parse_obstacles.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/faults.h"
#include "api/request/ranges.h"
#include "api/request/shared_members.h"

namespace fleetplan::api {

namespace {

using Entry = core::MovingObstacle::Entry;
using After = core::MovingObstacle::After;

constexpr std::array<std::string_view, 4> kObstacleMembers{"id", "radius", "motion", "after"};
constexpr std::array<std::string_view, 3> kEntryMembers{"t", "x", "y"};
constexpr std::array<std::string_view, 2> kAfter{"leaves", "stays"};  // see core::MovingObstacle::After
constexpr Range kTime{-kLongestTime, kLongestTime, "seconds"};

/// Reads an entry, in the map frame. Returns none when it has a fault.
std::optional<Entry> parse_entry(const JsonReader& item, const WorldFrame& frame) {
  const JsonReader json = item.object(kEntryMembers);
  const auto t = json.require("t").number(kTime);
  const auto x = json.require("x").number(kCoordinate);
  const auto y = json.require("y").number(kCoordinate);
  if (!t || !x || !y) return std::nullopt;
  return Entry{*t, frame.to_map({*x, *y})};
}

/// Reports an entry that is not later than the one before, or too far from it.
void check_order(const Entry& before, const Entry& entry, const JsonReader& item) {
  const double duration = entry.t - before.t;
  if (duration <= 0.0) {
    return item.find("t").fault(fault::kOutOfRange, [&] {
      return "t must be greater than that of the entry before, " + number_text(before.t) + ", not " +
             number_text(entry.t) + "; sort the entries by time and give each time once.";
    });
  }
  const double distance = (entry.position - before.position).norm();
  if (distance <= kLinearSpeed.most * duration) return;
  item.fault(fault::kSpeed, [&] {
    return "The obstacle moves " + number_text(distance) + " m in " + number_text(duration) +
           " s; it may be as fast as " + number_text(kLinearSpeed.most) +
           " m/s. Give one that appears elsewhere as another obstacle.";
  });
}

/// Returns the rest of the motion, from t = 0 on.
std::vector<Entry> cut(std::vector<Entry> motion, After after) {
  std::size_t first = 0;
  while (first < motion.size() && motion[first].t < 0.0) ++first;
  if (first == 0) return motion;
  if (first == motion.size()) {
    if (after == After::leaves) return {};
    return {{0.0, motion.back().position}};
  }
  const Entry& before = motion[first - 1];
  const Entry& next = motion[first];
  if (next.t > 0.0) {
    const double fraction = -before.t / (next.t - before.t);
    const core::Position position = before.position + fraction * (next.position - before.position);
    motion[--first] = {0.0, position};
  }
  motion.erase(motion.begin(), motion.begin() + static_cast<std::ptrdiff_t>(first));
  return motion;
}

std::vector<Entry> parse_motion(const JsonReader& member, const WorldFrame& frame, Quota& quota) {
  const JsonReader items = member.array();
  if (!items || !quota.take(items)) return {};
  if (items.size() == 0) items.fault(fault::kEmpty, "motion must have at least one entry.");
  std::vector<Entry> motion;
  motion.reserve(items.size());
  std::optional<Entry> before;
  for (const JsonReader item : items.items()) {
    const auto entry = parse_entry(item, frame);
    if (before && entry) check_order(*before, *entry, item);
    if (entry) motion.push_back(*entry);
    before = entry;
  }
  return motion;
}

core::MovingObstacle parse_obstacle(const JsonReader& item, const WorldFrame& frame, Quota& quota) {
  const JsonReader json = item.object(kObstacleMembers);
  core::MovingObstacle obstacle;
  obstacle.id = json.require("id").name().value_or("");
  obstacle.radius = json.require("radius").number(kLength).value_or(1.0);
  if (json.find("after").word(kAfter) == std::size_t{1}) obstacle.after = After::stays;
  const JsonReader motion = json.require("motion", "; give a list of {\"t\", \"x\", \"y\"}");
  obstacle.motion = cut(parse_motion(motion, frame, quota), obstacle.after);
  return obstacle;
}

}  // namespace

std::vector<core::MovingObstacle> parse_obstacles(const JsonReader& member, const WorldFrame& frame,
                                                  const Limits& limits, UniqueIds& ids) {
  const JsonReader items = member.array();
  if (!items) return {};
  Quota obstacles(limits.max_obstacles, "obstacles");
  if (!obstacles.take(items)) return {};
  Quota entries(limits.max_obstacle_entries, "entries of obstacles");
  std::vector<core::MovingObstacle> read;
  read.reserve(items.size());
  std::size_t index = 0;
  for (const JsonReader item : items.items()) {
    core::MovingObstacle obstacle = parse_obstacle(item, frame, entries);
    ids.check(UniqueIds::Kind::obstacle, obstacle.id, index++, item);
    if (!obstacle.motion.empty()) read.push_back(std::move(obstacle));
  }
  return read;
}

}  // namespace fleetplan::api
