#include "api/travel/travel_requests.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>

#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/request/fleet/geometry_faults.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/options.h"
#include "api/request/parse_body.h"
#include "api/request/shared_members.h"
#include "core/travel/assignment.h"

namespace fleetplan::api {

namespace {

/// The most poses of a list that are looked at at a time.
constexpr std::size_t kPosesOfAPart = 10'000;

/// Poses of a list, as far as they could be read.
struct Poses {
  std::vector<MatrixPose> poses;
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
    read.poses.push_back({pose->position, pose->theta});
    read.places.push_back(item);
  }
  return read;
}

MatrixPoses distinct(const std::vector<MatrixPose>& poses, core::Work& work) {
  constexpr std::size_t kWorkOfAPose = 64;
  MatrixPoses kept;
  std::map<std::tuple<double, double, std::optional<double>>, std::uint32_t> known;
  for (const MatrixPose& pose : poses) {
    if (work.met_after(kWorkOfAPose)) break;
    const auto next = static_cast<std::uint32_t>(kept.distinct.size());
    const auto [found, is_new] = known.try_emplace({pose.position.x(), pose.position.y(), pose.theta}, next);
    if (is_new) kept.distinct.push_back(pose);
    kept.index.push_back(found->second);
  }
  return kept;
}

/// Returns whether there are not too many pairs.
bool check_pose_pairs(const JsonReader& from, const JsonReader& to) {
  if (!from.array() || !to.array() || to.size() == 0 || from.size() <= kMaxPairs / to.size()) return true;
  to.fault(fault::kOutOfRange, "There are " + std::to_string(from.size()) + " x " +
                                   std::to_string(to.size()) +
                                   " pairs of poses; this service accepts at most " +
                                   std::to_string(kMaxPairs) + ". Send fewer at a time.");
  return false;
}

/// The zones of the robot, which the zones name as the first robot. The result has them for every robot of
/// the problem.
std::vector<core::Zone> zones_of_robot(std::vector<core::Zone> zones) {
  std::erase_if(zones, [](const core::Zone& zone) { return !zone.is_for(0); });
  for (core::Zone& zone : zones) zone.robots.clear();
  return zones;
}

using PosesPart = std::span<const MatrixPose>;

core::Goal goal_at(const MatrixPose& pose) { return {pose.position, pose.theta}; }

/// The robot at each pose of `from`. The first robot has all poses of `to` as its goals if they are to be
/// checked. Other robots have the last pose as goal where it matters, because a robot that stays has no way
/// out of zones.
std::vector<core::Robot> robots_at(PosesPart from, PosesPart to, bool checks_all, const core::Robot& like,
                                   const std::vector<core::Zone>& zones) {
  const bool any_to_leave =
      std::any_of(zones.begin(), zones.end(), [](const core::Zone& zone) { return zone.may_leave; });
  std::vector<core::Robot> robots;
  for (const MatrixPose& pose : from) {
    core::Robot& robot = robots.emplace_back(like);
    robot.start = {pose.position, pose.theta.value_or(0.0)};
    if (any_to_leave) robot.goal = goal_at(to.back());
  }
  robots.front().goal = goal_at(to.back());
  if (!checks_all) return robots;
  for (const MatrixPose& pose : to.first(to.size() - 1)) robots.front().via.push_back(goal_at(pose));
  return robots;
}

core::ProblemConditions conditions_of(const core::PlanOptions& options,
                                      const std::vector<core::Zone>& zones) {
  core::ProblemConditions conditions = core::conditions_of(options);
  conditions.zones = zones;
  conditions.one_at_a_time = true;
  return conditions;
}

/// Calls `look` with the begins and sizes of parts of two lists, which make up all pairs. Returns false as
/// soon as it does.
template <typename Look>
bool for_each_part(std::size_t rows, std::size_t columns, const Look& look) {
  // Bounded: a part has thousands of poses, and `look` ends with the stop condition.
  for (std::size_t row = 0; row < rows; row += kPosesOfAPart) {
    for (std::size_t column = 0; column < columns; column += kPosesOfAPart) {
      if (!look(row, std::min(kPosesOfAPart, rows - row), column, std::min(kPosesOfAPart, columns - column)))
        return false;
    }
  }
  return true;
}

/// Checks whether the robot can have the poses.
class PoseCheck {
 public:
  PoseCheck(const MatrixRequest& request, const Poses& from, const Poses& to, const WorldFrame& frame)
      : request_(request), from_(from), to_(to), frame_(frame) {}

  /// Reports the poses that it cannot have as faults of `root`. Ends early if the work is met.
  void run(const JsonReader& root, core::Work& work) const {
    NearestGoals nearest(request_.map, request_.zones, kPosesOfAPart, request_.options.inflation, frame_,
                         work.reading());
    for_each_part(from_.poses.size(), to_.poses.size(),
                  [&](std::size_t row, std::size_t rows, std::size_t column, std::size_t columns) {
                    auto robots = robots_at(PosesPart(from_.poses).subspan(row, rows),
                                            PosesPart(to_.poses).subspan(column, columns), row == 0,
                                            request_.robot, request_.zones);
                    const auto made = core::Problem::create(request_.map, std::move(robots),
                                                            conditions_of(request_.options, request_.zones),
                                                            work.reading());
                    const auto* faults = std::get_if<core::ProblemFaults>(&made);
                    if (faults == nullptr) return true;
                    report(*faults, row, column, nearest);
                    root.count_more_faults(faults->total - faults->listed.size());
                    return faults->finished || !work.look();
                  });
  }

 private:
  /// Each pose is reported with the first part that it is in.
  void report(const core::ProblemFaults& faults, std::size_t row, std::size_t column,
              NearestGoals& nearest) const {
    for (const core::ProblemFault& found : faults.listed) {
      const bool is_start = found.kind == core::ProblemFault::Kind::start_in_obstacle;
      if (is_start ? column > 0 : row > 0 || found.robot > 0) continue;
      const JsonReader& place = is_start ? from_.places[row + found.robot] : to_.places[column + found.goal];
      place.fault(is_start ? fault::kStartInObstacle : fault::kGoalInObstacle,
                  describe_pose(found, place, request_.robot, request_.options.inflation, request_.zones,
                                request_.map->grid(), frame_, nearest));
    }
  }

  const MatrixRequest& request_;
  const Poses& from_;
  const Poses& to_;
  const WorldFrame& frame_;
};

constexpr std::array<std::string_view, 2> kMatrixFormats{"numbers", "integers"};  // see MatrixFormat

core::TravelQuestions questions_of(PosesPart from, PosesPart to) {
  core::TravelQuestions questions;
  std::vector<std::size_t> all;
  for (const MatrixPose& pose : from) {
    all.push_back(all.size());
    questions.any_heading.push_back(!pose.theta);
  }
  for (const MatrixPose& pose : to) questions.columns.push_back({goal_at(pose), all});
  return questions;
}

}  // namespace

std::optional<MatrixRequest> parse_matrix_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& work, core::MapCache* maps) {
  ParsedOptions options = parse_options(root.find("options"));
  work.set_budget(effective_budget(options, limits));
  auto map = parse_map(root.require("map"), limits.max_cells);
  if (map) check_lattice(root.find("options"), options.plan, map->grid, limits);
  std::vector<ParsedRobot> robot(1);
  if (const auto read = parse_lone_robot(root.require("robot"))) robot.front().robot = *read;
  const WorldFrame frame = map ? map->frame : WorldFrame{};
  std::vector<std::string>& warnings = options.warnings;
  if (map) warnings.insert(warnings.end(), map->warnings.begin(), map->warnings.end());
  const auto zones = zones_of_robot(parse_zones(root.find("zones"), map ? &*map : nullptr, limits, robot,
                                                warnings, ZoneRobots::also_others));
  const JsonReader from_member = root.require("from", "; give a list of poses {\"x\", \"y\"}");
  const JsonReader to_member = root.require("to", "; give a list of poses {\"x\", \"y\"}");
  const auto format = root.find("format").word(kMatrixFormats);
  if (!check_pose_pairs(from_member, to_member)) return std::nullopt;
  const Poses from = parse_poses(from_member, "from", frame);
  const Poses to = parse_poses(to_member, "to", frame);
  if (!map || root.fault_count() > 0 || work.met()) return std::nullopt;
  const auto static_map = maps != nullptr ? maps->map_of(std::move(map->grid), work.reading())
                                          : core::static_map(std::move(map->grid), work.reading());
  if (!static_map) return work.look(), std::nullopt;
  MatrixRequest request{.map = static_map,
                        .robot = robot.front().robot,
                        .zones = zones,
                        .from = distinct(from.poses, work),
                        .to = distinct(to.poses, work),
                        .options = options.plan,
                        .budget = effective_budget(options, limits),
                        .format = static_cast<MatrixFormat>(format.value_or(0)),
                        .warnings = std::move(options.warnings)};
  PoseCheck(request, from, to, frame).run(root, work);
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  if (auto warning = budget_warning(options, limits)) request.warnings.push_back(std::move(*warning));
  return request;
}

std::optional<core::TravelAnswers> matrix_times(const MatrixRequest& request, const core::StopCondition& stop,
                                                core::Executor& executor,
                                                const std::function<bool()>& go_on) {
  const PosesPart from = request.from.distinct;
  const PosesPart to = request.to.distinct;
  core::TravelAnswers answers(to.size(), std::vector<std::optional<core::Travel>>(from.size()));
  const bool finished = for_each_part(
      from.size(), to.size(),
      [&](std::size_t row, std::size_t rows, std::size_t column, std::size_t columns) {
        const PosesPart starts = from.subspan(row, rows);
        const PosesPart goals = to.subspan(column, columns);
        auto made =
            core::Problem::create(request.map, robots_at(starts, goals, false, request.robot, request.zones),
                                  conditions_of(request.options, request.zones), stop);
        const auto* problem = std::get_if<core::Problem>(&made);
        if (problem == nullptr) return false;  // it was stopped, because the poses have already been checked
        auto part =
            core::travel_times(*problem, request.options, questions_of(starts, goals), stop, executor, go_on);
        if (!part) return false;
        for (std::size_t k = 0; k < columns; ++k) {
          std::move((*part)[k].begin(), (*part)[k].end(),
                    answers[column + k].begin() + static_cast<std::ptrdiff_t>(row));
        }
        return true;
      });
  if (!finished) return std::nullopt;
  return answers;
}

namespace {

constexpr std::array<std::pair<const char*, double core::Travel::*>, 2> kMatrices{
    {{"seconds", &core::Travel::seconds}, {"metres", &core::Travel::metres}}};

/// Rounds up. What rounding may have added to a whole number does not count.
std::int64_t rounded_up(double number) {
  constexpr double kRounding = 1e-6;
  return static_cast<std::int64_t>(std::max(std::ceil(number - kRounding), 0.0));
}

/// Returns the whole number that stands for no way. It is more than a tour over all poses of `from` can take,
/// in seconds and in metres, so that solvers avoid it. It has no more than 32 bits with a sign, which leaves
/// solvers room for sums of many numbers. None if `stop` is met first.
std::optional<std::int64_t> unreachable_number(const MatrixPoses& from, const core::TravelAnswers& answers,
                                               const core::StopCondition& stop) {
  std::int64_t most = 0;
  for (const auto& [key, number] : kMatrices) {
    std::vector<std::int64_t> longest(from.distinct.size(), 0);
    for (const auto& column : answers) {
      if (stop.met()) return std::nullopt;
      for (std::size_t row = 0; row < column.size(); ++row) {
        if (column[row]) longest[row] = std::max(longest[row], rounded_up((*column[row]).*number));
      }
    }
    std::int64_t tour = 0;
    for (const std::uint32_t row : from.index) tour += longest[row];
    most = std::max(most, tour);
  }
  return std::min<std::int64_t>(most + 1, std::numeric_limits<std::int32_t>::max());
}

}  // namespace

std::optional<std::string> write_matrix(const MatrixRequest& request, const core::TravelAnswers& answers,
                                        const core::StopCondition& stop) {
  constexpr std::size_t kBytesOfANumber = 20;
  const bool is_whole = request.format == MatrixFormat::integers;
  const auto unreachable =
      is_whole ? unreachable_number(request.from, answers, stop) : std::optional<std::int64_t>(0);
  if (!unreachable) return std::nullopt;
  JsonWriter json;
  json.reserve(2 * kBytesOfANumber * request.rows() * request.columns());
  json.begin_object();
  for (const auto& [key, number] : kMatrices) {
    json.key(key).begin_array();
    for (const std::uint32_t row : request.from.index) {
      if (stop.met()) return std::nullopt;
      json.begin_array();
      for (const std::uint32_t column : request.to.index) {
        const std::optional<core::Travel>& way = answers[column][row];
        if (is_whole) {
          json.value(way ? rounded_up((*way).*number) : *unreachable);
        } else {
          json.value(way ? std::optional((*way).*number) : std::nullopt);
        }
      }
      json.end_array();
    }
    json.end_array();
  }
  if (is_whole) json.member("unreachable", *unreachable);
  json.key("warnings").begin_array();
  for (const std::string& warning : request.warnings) json.value(std::string_view(warning));
  json.end_array().end_object();
  return json.take();
}

namespace {

constexpr std::array<std::string_view, 5> kTaskMembers{"id", "goals", "robots", "due", "weight"};
/// Weights that differ by less count the same where there are too few robots.
constexpr double kSameWeight = 1e-6;

class TaskReader {
 public:
  TaskReader(const AssignRequest& request, const Limits& limits)
      : request_(request),
        names_(request.plan.problem.robots(), "robots of the request"),
        goals_(limits.max_goals, "goals of tasks") {}

  void read(const JsonReader& item, AssignRequest& request) {
    const JsonReader json = item.object(kTaskMembers);
    if (!json) return;
    ReceivedTask& received = request.received.emplace_back();
    received.id = json.require("id").name().value_or("");
    check_id(json.find("id"), received.id);
    const JsonReader goals = json.require("goals", "; give a list of goals, as a robot has");
    if (goals.array() && goals.size() == 0) goals.fault(fault::kEmpty, "A task has at least one goal.");
    core::Task& task = request.tasks.emplace_back();
    if (goals) {
      task.goals = parse_goals(json, request_.plan.frame, goals_).goals;
      for (const JsonReader goal : goals.items()) reject_any_of(goal);
    }
    task.robots = robots(json.find("robots"));
    json.find("due").number(kDuration);
    received.weight = json.find("weight").number(kWeight).value_or(1.0);
    received.goals = goals;
  }

 private:
  /// Arrivals are those at given poses.
  static void reject_any_of(const JsonReader& goal) {
    const JsonReader any_of = goal.find("any_of");
    if (!any_of) return;
    any_of.fault(fault::kUnknownKey, "Goals of tasks have no any_of; give each of them a pose.");
  }

  void check_id(const JsonReader& member, const std::string& id) {
    const std::size_t index = ids_.size();
    if (id.empty()) return;
    const auto [first, is_new] = ids_.emplace(id, index);
    if (is_new) return;
    member.fault(fault::kDuplicate, [&] {
      return "Another task before this one has the id " + in_quotes(id) +
             ", too; ids of tasks must be unique.";
    });
  }

  /// The robots that may do a task, ascending; all if they are not given.
  std::vector<std::size_t> robots(const JsonReader& member) const {
    std::vector<std::size_t> robots;
    const JsonReader list = member.array();
    if (!member) {
      robots.resize(request_.plan.problem.robots().size());
      std::iota(robots.begin(), robots.end(), std::size_t{0});
    }
    if (!list) return robots;
    if (list.size() == 0) {
      list.fault(fault::kEmpty, "robots must name at least one robot; leave it out if any may do the task.");
    }
    for (const JsonReader item : list.items()) {
      if (const auto robot = names_.find(item)) robots.push_back(*robot);
    }
    std::sort(robots.begin(), robots.end());
    robots.erase(std::unique(robots.begin(), robots.end()), robots.end());
    return robots;
  }

  const AssignRequest& request_;
  const RobotNames names_;
  Quota goals_;
  std::unordered_map<std::string, std::size_t> ids_;
};

/// Returns whether there are not too many pairs of robots and tasks.
bool check_task_pairs(const JsonReader& tasks, std::size_t robots) {
  if (!tasks || tasks.size() <= kMaxPairs / robots) return true;
  tasks.fault(fault::kOutOfRange, "There are " + std::to_string(tasks.size()) + " tasks for " +
                                      std::to_string(robots) + " robots; this service accepts at most " +
                                      std::to_string(kMaxPairs) +
                                      " pairs. Send the tasks that are due first.");
  return false;
}

}  // namespace

std::optional<AssignRequest> parse_assign_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& work, core::MapCache* maps) {
  const JsonReader member =
      root.require("request", "; give a request of /v1/plan").object(kPlanRequestMembers);
  const JsonReader tasks = root.require("tasks", "; give a list of tasks").array();
  if (!member) return std::nullopt;
  auto plan = parse_plan_request(member, limits, work, maps);
  // With faults, robots may be missing that tasks name.
  if (!plan || root.fault_count() > 0) return std::nullopt;
  AssignRequest request{.plan = std::move(*plan), .tasks = {}, .received = {}, .request = member};
  if (!tasks || !check_task_pairs(tasks, request.plan.problem.robots().size())) return std::nullopt;
  TaskReader reader(request, limits);
  for (const JsonReader item : tasks.items()) reader.read(item, request);
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  return request;
}

std::optional<std::vector<Assigned>> assigned(const AssignRequest& request,
                                              const std::vector<std::vector<double>>& arrivals,
                                              const core::StopCondition& stop) {
  const std::size_t robots = request.plan.problem.robots().size();
  std::vector<std::vector<double>> costs;
  std::vector<std::vector<double>> times;
  std::vector<std::int64_t> importance;
  for (std::size_t task = 0; task < request.tasks.size(); ++task) {
    if (stop.met()) return std::nullopt;
    std::vector<double>& cost = costs.emplace_back(robots, core::kForever);
    const double weight = request.received[task].weight;
    importance.push_back(std::llround(weight / kSameWeight));
    std::vector<double>& time = times.emplace_back(robots, core::kForever);
    for (std::size_t k = 0; k < request.tasks[task].robots.size(); ++k) {
      time[request.tasks[task].robots[k]] = arrivals[task][k];
      cost[request.tasks[task].robots[k]] = weight * arrivals[task][k];
    }
  }
  const auto columns = core::assign(costs, importance, stop);
  if (!columns) return std::nullopt;
  std::vector<Assigned> all;
  for (std::size_t task = 0; task < costs.size(); ++task) {
    Assigned& one = all.emplace_back();
    one.robot = (*columns)[task];
    if (one.robot) one.t_arrive = times[task][*one.robot];
    one.any_way = std::any_of(arrivals[task].begin(), arrivals[task].end(),
                              [](double arrival) { return arrival < core::kForever; });
  }
  return all;
}

namespace {

/// The robot as given, with the goals of the task after its own.
void write_robot(JsonWriter& json, const JsonValue& given, const JsonReader& goals) {
  json.begin_object();
  std::optional<JsonValue> one;
  std::optional<JsonValue> list;
  for (const JsonValue member : given.children()) {
    if (member.key() == "goal" || member.key() == "goals") {
      (member.key() == "goal" ? one : list) = member;
      continue;
    }
    json.key(member.key());
    copy_json(json, member);
  }
  json.key("goals").begin_array();
  if (one) copy_json(json, *one);
  if (list) {
    for (const JsonValue goal : list->children()) copy_json(json, goal);
  }
  for (const JsonValue goal : goals.value().children()) copy_json(json, goal);
  json.end_array().end_object();
}

void write_robots(JsonWriter& json, const JsonValue& given, const AssignRequest& request,
                  const std::vector<std::optional<std::size_t>>& task_of) {
  json.begin_array();
  auto task = task_of.begin();
  for (const JsonValue robot : given.children()) {
    if (*task) {
      write_robot(json, robot, request.received[**task].goals);
    } else {
      copy_json(json, robot);
    }
    ++task;
  }
  json.end_array();
}

}  // namespace

std::string write_assigned(const AssignRequest& request, const std::vector<Assigned>& assigned) {
  const std::vector<core::Robot>& robots = request.plan.problem.robots();
  std::vector<std::optional<std::size_t>> task_of(robots.size());
  for (std::size_t task = 0; task < assigned.size(); ++task) {
    if (assigned[task].robot) task_of[*assigned[task].robot] = task;
  }
  JsonWriter json;
  json.begin_object();
  for (const JsonValue member : request.request.value().children()) {
    if (member.key() == "assigned" || member.key() == "unassigned") continue;
    json.key(member.key());
    if (member.key() == "robots") {
      write_robots(json, member, request, task_of);
    } else {
      copy_json(json, member);
    }
  }
  json.key("assigned").begin_array();
  for (std::size_t task = 0; task < assigned.size(); ++task) {
    const Assigned& one = assigned[task];
    if (!one.robot) continue;
    json.begin_object().member("task", request.received[task].id).member("robot", robots[*one.robot].id);
    json.member("t_arrive", one.t_arrive).end_object();
  }
  json.end_array().key("unassigned").begin_array();
  for (std::size_t task = 0; task < assigned.size(); ++task) {
    if (assigned[task].robot) continue;
    json.begin_object().member("task", request.received[task].id);
    json.member("reason", assigned[task].any_way ? "no_robot" : "no_way").end_object();
  }
  json.end_array().end_object();
  return json.take();
}

}  // namespace fleetplan::api
