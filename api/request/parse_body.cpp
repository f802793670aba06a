#include "api/request/parse_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/shared_members.h"
#include "core/map/lattice.h"

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

/// Reports an entry that is not later than the previous entry, or too far from it.
void check_order(const Entry& before, const Entry& entry, const JsonReader& item) {
  const double duration = entry.t - before.t;
  if (duration <= 0.0) {
    return item.find("t").fault(fault::kOutOfRange, [&] {
      return "t must be greater than that of the entry before, " + number_text(before.t) + ", not " +
             number_text(entry.t) + "; sort the entries by time and give each time once.";
    });
  }
  const double distance = (entry.position - before.position).norm();
  if (distance <= kLinearSpeed.max * duration) return;
  item.fault(fault::kSpeed, [&] {
    return "The obstacle moves " + number_text(distance) + " m in " + number_text(duration) +
           " s; it may be as fast as " + number_text(kLinearSpeed.max) +
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

namespace {

/// The greatest usual heading, radians: one beyond a turn either way is probably in degrees.
constexpr double kUsualHeading = 6.2831853071795865;  // radians
/// The greatest usual speeds. No robot is faster: three turns a second, and 72 km/h.
constexpr double kUsualAngularSpeed = 20.0;  // radians per second
constexpr double kUsualLinearSpeed = 20.0;   // metres per second

/// Numbers of one kind that are larger than usual: how many, and the first of them.
class Unusual {
 public:
  explicit Unusual(double usual) : usual_(usual) {}

  template <typename Name>
  void look_at(double number, const Name& name) {
    if (!(std::abs(number) > usual_)) return;
    if (count_ == 0) first_ = name() + " is " + number_text(number);
    ++count_;
  }
  template <typename Name>
  void look_at(const JsonReader& member, const Name& name) {
    if (member.is_number()) look_at(*member.value().number(), name);
  }

  void tell(std::vector<std::string>& warnings, const std::string& unit, const std::string& advice) const {
    if (count_ == 0) return;
    const std::string others = count_ == 1 ? "" : " (and " + std::to_string(count_ - 1) + " more like it)";
    warnings.push_back("The " + first_ + ' ' + unit + others + advice);
  }

 private:
  double usual_;
  std::size_t count_ = 0;
  std::string first_;
};

/// Returns warnings about valid numbers that are probably in other units: headings of starts, goals and
/// one-way zones, and speeds of robots. There is a sentence for each kind, with the first place and the
/// number of places. `zones` is the member of the request, or absent. Costs less than reading the request.
std::vector<std::string> unit_warnings(const std::vector<ParsedRobot>& robots, const JsonReader& zones) {
  Unusual headings(kUsualHeading);
  Unusual turning(kUsualAngularSpeed);
  Unusual driving(kUsualLinearSpeed);
  const auto of = [](const char* what, const std::string& id) {
    return [what, &id] { return std::string(what) + in_quotes(id); };
  };
  for (const ParsedRobot& read : robots) {
    if (read.start && read.start.work().met_after(1)) break;
    const std::string& id = read.robot.id;
    headings.look_at(read.start.find("theta"), of("heading at the start of robot ", id));
    for (const JsonReader& goal : read.goals) {
      headings.look_at(goal.find("theta"), of("heading at a goal of robot ", id));
    }
    turning.look_at(read.robot.angular_speed, of("angular speed of robot ", id));
    driving.look_at(read.robot.linear_speed, of("linear speed of robot ", id));
  }
  if (zones && zones.value().is_array()) {
    for (const JsonReader zone : zones.items()) {
      if (zone.work().met_after(1)) break;
      const std::string id(zone.find("id").string().value_or(""));
      headings.look_at(zone.find("heading"), of("heading of zone ", id));
    }
  }
  std::vector<std::string> warnings;
  headings.tell(warnings, "rad", ", more than a whole turn. Headings are in radians: is it in degrees?");
  turning.tell(warnings, "rad/s", ", more than any robot turns. Is it in degrees per second?");
  driving.tell(warnings, "m/s", ", more than any robot drives. Is it in millimetres per second?");
  return warnings;
}

ErrorCode code_of(JsonError::Kind kind) {
  switch (kind) {
    case JsonError::Kind::malformed:
      return ErrorCode::malformed_json;
    case JsonError::Kind::too_deep:
      return ErrorCode::too_deep;
    case JsonError::Kind::too_large:
    case JsonError::Kind::unfinished:
      break;
  }
  return ErrorCode::invalid_request;
}

/// Sets the default of start_safe_interval. A fleet that is planned anew while it drives needs no start kept
/// free: its plans begin where robots are.
void set_default_start_safe_interval(const JsonReader& options, const std::vector<ParsedRobot>& robots,
                                     core::PlanOptions& plan) {
  const bool is_given = options && options.find("start_safe_interval");
  const bool in_motion = std::any_of(robots.begin(), robots.end(), [](const ParsedRobot& read) {
    return read.committed || read.robot.previous;
  });
  // Within a horizon, robots that leave their places in time make repairs unnecessary. 1000 robots in rounds
  // of 5 s serve 1.1 times as many goals as with 0.
  constexpr double kWithHorizon = 1.0;
  if (in_motion && !is_given) plan.start_safe_interval = plan.horizon ? kWithHorizon : 0.0;
}

}  // namespace

void check_lattice(const JsonReader& options, const core::PlanOptions& plan, const core::OccupancyGrid& grid,
                   const Limits& limits) {
  if (!plan.lattice_spacing) return;
  const JsonReader spacing = options.find("lattice_spacing");
  const std::int64_t columns = core::Lattice::vertices_along(grid.width(), *plan.lattice_spacing);
  const std::int64_t rows = core::Lattice::vertices_along(grid.height(), *plan.lattice_spacing);
  if (columns < 1 || rows < 1) {
    spacing.fault(fault::kOutOfRange, "A lattice with a spacing of " + number_text(*plan.lattice_spacing) +
                                          " m has no vertex on this map of " + number_text(grid.width()) +
                                          " m x " + number_text(grid.height()) +
                                          " m. Use at most twice its shorter side.");
  } else if (columns > limits.max_cells / rows) {
    spacing.fault(fault::kOutOfRange, "A lattice with a spacing of " + number_text(*plan.lattice_spacing) +
                                          " m has " + std::to_string(columns) + " x " + std::to_string(rows) +
                                          " vertices on this map; this service accepts at most " +
                                          std::to_string(limits.max_cells) + ". Use a larger spacing.");
  }
}

RequestError request_error(const FaultList& faults) {
  RequestError error{ErrorCode::invalid_request, "", faults.listed(), faults.count()};
  if (faults.count() == 1) {
    error.detail = error.faults.front().detail;
  } else if (faults.count() == error.faults.size()) {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; see errors.";
  } else {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; errors lists the first " +
                   std::to_string(error.faults.size()) + ".";
  }
  return error;
}

RequestError request_error(const JsonError& error, const core::Work& work) {
  if (error.kind == JsonError::Kind::unfinished) return unfinished(work);
  RequestError request{code_of(error.kind), error.detail, {}, 0};
  if (request.code == ErrorCode::invalid_request) {
    request.faults.push_back({"", fault::kOutOfRange, error.detail});
    request.faults_total = 1;
  }
  return request;
}

RequestError unfinished(const core::Work& work) {
  if (work.cancelled()) {
    return {ErrorCode::draining, kDrainingDetail, {}, 0};
  }
  return {ErrorCode::parse_unfinished,
          "Reading the request was given up after " +
              std::string(work.has_budget() ? "its time budget, or three seconds of CPU time"
                                            : "a second of CPU time") +
              ": send a smaller map, or fewer robots, actions or other values" +
              (work.has_budget() ? ", or increase options.time_budget_ms." : "."),
          {},
          0};
}

RequestedDependencies requested_dependencies(const Fleet& fleet) {
  const ParsedOptions& options = fleet.options;
  RequestedDependencies requested{
      options.dependencies, options.dependency_slack, {}, options.execution_margin, {}};
  for (const ParsedRobot& read : fleet.robots) {
    requested.margins.push_back(read.execution_margin.value_or(options.execution_margin));
    requested.has_own.push_back(read.execution_margin.has_value());
  }
  return requested;
}

Fleet parse_fleet(const JsonReader& root, const Limits& limits,
                  const std::function<void(const ParsedOptions&)>& set_budget, GivenPositions* given) {
  Fleet fleet;
  fleet.options = parse_options(root.find("options"));
  set_budget(fleet.options);
  fleet.map = parse_map(root.require("map"), limits.max_cells);
  if (fleet.map) {
    fleet.map->frame.given = given;
    check_lattice(root.find("options"), fleet.options.plan, fleet.map->grid, limits);
  }
  const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
  UniqueIds ids;
  fleet.robots = parse_robots(root.require("robots"), root.find("robot_defaults"), frame, limits, ids);
  fleet.obstacles = parse_obstacles(root.find("obstacles"), frame, limits, ids);
  std::vector<std::string>& warnings = fleet.options.warnings;
  if (fleet.map) warnings.insert(warnings.end(), fleet.map->warnings.begin(), fleet.map->warnings.end());
  fleet.zones =
      parse_zones(root.find("zones"), fleet.map ? &*fleet.map : nullptr, limits, fleet.robots, warnings);
  for (std::string& warning : unit_warnings(fleet.robots, root.find("zones"))) {
    warnings.push_back(std::move(warning));
  }
  fleet.metadata = parse_metadata(root);
  set_default_start_safe_interval(root.find("options"), fleet.robots, fleet.options.plan);
  return fleet;
}

}  // namespace fleetplan::api
