#include "api/travel/matrix_request.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "api/json/faults.h"
#include "api/json/json_writer.h"
#include "api/request/fleet/geometry_faults.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/map/parse_map.h"
#include "api/request/options.h"
#include "api/request/parse_body.h"
#include "api/request/zones/parse_zones.h"

namespace fleetplan::api {

namespace {

/// Poses of a list, as far as they could be read.
struct Poses {
  std::vector<core::Goal> poses;
  std::vector<JsonReader> places;
};

Poses parse_poses(const JsonReader& list, const char* name, const WorldFrame& frame) {
  Poses read;
  const JsonReader items = list.array();
  if (!items) return read;
  if (items.size() == 0) items.fault(fault::kEmpty, std::string(name) + " must contain at least one pose.");
  for (const JsonReader item : items.items()) {
    const auto pose = parse_plain_pose(item, frame);
    if (!pose) continue;
    read.poses.push_back(*pose);
    read.places.push_back(item);
  }
  return read;
}

/// Returns whether there are not too many pairs.
bool check_pairs(const JsonReader& from, const JsonReader& to) {
  if (!from.array() || !to.array() || to.size() == 0 || from.size() <= kMostPairs / to.size()) return true;
  to.fault(fault::kOutOfRange, "There are " + std::to_string(from.size()) + " x " +
                                   std::to_string(to.size()) +
                                   " pairs of poses; this service accepts at most " +
                                   std::to_string(kMostPairs) + ". Send fewer at a time.");
  return false;
}

/// The zones that are for the robot, which is the first one of those that they name. So they are for every
/// robot of the problem.
std::vector<core::Zone> zones_of_robot(std::vector<core::Zone> zones) {
  std::erase_if(zones, [](const core::Zone& zone) { return !zone.is_for(0); });
  for (core::Zone& zone : zones) zone.robots.clear();
  return zones;
}

/// The robot at each pose of `from`. The first one has all poses of `to` as its goals, so that they are
/// checked; the others have the last of them, as a robot that stays has no way out of zones.
std::vector<core::Robot> robots_at(const Poses& from, const Poses& to, const core::Robot& like,
                                   const std::vector<core::Zone>& zones) {
  const bool any_to_leave =
      std::any_of(zones.begin(), zones.end(), [](const core::Zone& zone) { return zone.may_leave; });
  std::vector<core::Robot> robots;
  for (const core::Goal& pose : from.poses) {
    core::Robot& robot = robots.emplace_back(like);
    robot.start = {pose.position, pose.theta.value_or(0.0)};
    if (any_to_leave) robot.goal = to.poses.back();
  }
  robots.front().via.assign(to.poses.begin(), to.poses.end() - 1);
  robots.front().goal = to.poses.back();
  return robots;
}

/// Reports the poses that the robot cannot have.
void report(const core::ProblemFaults& faults, const Poses& from, const Poses& to, const core::Robot& robot,
            const std::vector<core::Zone>& zones, const core::OccupancyGrid& grid, const WorldFrame& frame) {
  for (const core::ProblemFault& found : faults.listed) {
    const bool is_start = found.kind == core::ProblemFault::Kind::start_in_obstacle;
    if (!is_start && found.robot > 0) continue;  // the same as that of the first robot
    const JsonReader& place = is_start ? from.places[found.robot] : to.places[found.goal];
    place.fault(is_start ? fault::kStartInObstacle : fault::kGoalInObstacle,
                describe_pose(found, place, robot.radius, zones, grid, frame));
  }
}

core::TravelQuestions questions_of(const Poses& from, const Poses& to) {
  core::TravelQuestions questions;
  std::vector<std::size_t> all;
  for (const core::Goal& pose : from.poses) {
    all.push_back(all.size());
    questions.any_heading.push_back(!pose.theta);
  }
  for (const core::Goal& pose : to.poses) questions.columns.push_back({pose, all});
  return questions;
}

}  // namespace

std::optional<MatrixRequest> parse_matrix_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& stop, core::MapCache* maps) {
  ParsedOptions options = parse_options(root.find("options"));
  stop.set_budget(effective_budget(options, limits));
  auto map = parse_map(root.require("map"), limits.max_cells);
  if (map) check_lattice(root.find("options"), options.plan, map->grid, limits);
  std::vector<ParsedRobot> robot(1);
  if (const auto read = parse_lone_robot(root.require("robot"))) robot.front().robot = *read;
  const WorldFrame frame = map ? map->frame : WorldFrame{};
  const auto zones = zones_of_robot(
      parse_zones(root.find("zones"), map ? &*map : nullptr, limits, robot, ZoneRobots::also_others));
  const JsonReader from_member = root.require("from", "; give a list of poses {\"x\", \"y\"}");
  const JsonReader to_member = root.require("to", "; give a list of poses {\"x\", \"y\"}");
  if (!check_pairs(from_member, to_member)) return std::nullopt;
  const Poses from = parse_poses(from_member, "from", frame);
  const Poses to = parse_poses(to_member, "to", frame);
  if (!map || root.fault_count() > 0 || stop.met()) return std::nullopt;
  const auto static_map = maps != nullptr ? maps->map_of(std::move(map->grid), stop.reading())
                                          : core::static_map(std::move(map->grid), stop.reading());
  if (!static_map) return stop.look(), std::nullopt;
  core::ProblemConditions conditions;
  conditions.wall_overlap = std::max(0.0, options.plan.start_overlap - options.plan.inflation);
  conditions.inflation = options.plan.inflation;
  conditions.zones = zones;
  conditions.one_at_a_time = true;
  auto made = core::Problem::create(static_map, robots_at(from, to, robot.front().robot, zones),
                                    std::move(conditions), stop.reading());
  if (const auto* faults = std::get_if<core::ProblemFaults>(&made)) {
    if (!faults->finished) stop.look();
    report(*faults, from, to, robot.front().robot, zones, static_map->grid(), frame);
    root.count_more_faults(faults->total - faults->listed.size());
    return std::nullopt;
  }
  MatrixRequest request{.problem = std::move(std::get<core::Problem>(made)),
                        .options = options.plan,
                        .questions = questions_of(from, to),
                        .budget = effective_budget(options, limits),
                        .warnings = std::move(options.warnings)};
  if (auto warning = budget_warning(options, limits)) request.warnings.push_back(std::move(*warning));
  return request;
}

std::optional<std::string> write_matrix(const MatrixRequest& request, const core::TravelAnswers& answers,
                                        const core::StopCondition& stop) {
  constexpr std::size_t kBytesOfANumber = 20;
  JsonWriter json;
  json.reserve(2 * kBytesOfANumber * request.rows() * request.columns());
  json.begin_object();
  for (const auto& [key, number] :
       {std::pair{"seconds", &core::Travel::seconds}, std::pair{"metres", &core::Travel::metres}}) {
    json.key(key).begin_array();
    for (std::size_t row = 0; row < request.rows(); ++row) {
      if (stop.met()) return std::nullopt;
      json.begin_array();
      for (const auto& column : answers) {
        const std::optional<core::Travel>& way = column[row];
        json.value(way ? std::optional((*way).*number) : std::nullopt);
      }
      json.end_array();
    }
    json.end_array();
  }
  json.key("warnings").begin_array();
  for (const std::string& warning : request.warnings) json.value(std::string_view(warning));
  json.end_array().end_object();
  return json.take();
}

}  // namespace fleetplan::api
