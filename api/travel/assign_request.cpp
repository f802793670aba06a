#include "api/travel/assign_request.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "api/json/faults.h"
#include "api/json/json_writer.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/ranges.h"
#include "api/request/shared_members.h"
#include "core/geometry/segment.h"
#include "core/travel/assignment.h"

namespace fleetplan::api {

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
    request.ids.push_back(json.require("id").name().value_or(""));
    check_id(json.find("id"), request.ids.back());
    const JsonReader goals = json.require("goals", "; give a list of goals, as a robot has");
    if (goals.array() && goals.size() == 0) goals.fault(fault::kEmpty, "A task has at least one goal.");
    core::Task& task = request.tasks.emplace_back();
    if (goals) {
      task.goals = parse_goals(json, request_.plan.frame, goals_).goals;
      for (const JsonReader goal : goals.items()) reject_any_of(goal);
    }
    task.robots = robots(json.find("robots"));
    json.find("due").number(kDuration);
    request.weights.push_back(json.find("weight").number(kWeight).value_or(1.0));
    request.goals.push_back(goals);
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
bool check_pairs(const JsonReader& tasks, std::size_t robots) {
  if (!tasks || tasks.size() <= kMostPairs / robots) return true;
  tasks.fault(fault::kOutOfRange, "There are " + std::to_string(tasks.size()) + " tasks for " +
                                      std::to_string(robots) + " robots; this service accepts at most " +
                                      std::to_string(kMostPairs) +
                                      " pairs. Send the tasks that are due first.");
  return false;
}

}  // namespace

std::optional<AssignRequest> parse_assign_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& stop, core::MapCache* maps) {
  const JsonReader member =
      root.require("request", "; give a request of /v1/plan").object(kPlanRequestMembers);
  const JsonReader tasks = root.require("tasks", "; give a list of tasks").array();
  if (!member) return std::nullopt;
  auto plan = parse_plan_request(member, limits, stop, maps);
  // With faults, robots may be missing that tasks name.
  if (!plan || root.fault_count() > 0) return std::nullopt;
  AssignRequest request{
      .plan = std::move(*plan), .tasks = {}, .ids = {}, .weights = {}, .goals = {}, .request = member};
  if (!tasks || !check_pairs(tasks, request.plan.problem.robots().size())) return std::nullopt;
  TaskReader reader(request, limits);
  for (const JsonReader item : tasks.items()) reader.read(item, request);
  if (root.fault_count() > 0 || stop.met()) return std::nullopt;
  return request;
}

std::optional<std::vector<std::optional<Assigned>>> assigned(const AssignRequest& request,
                                                             const std::vector<std::vector<double>>& arrivals,
                                                             const core::StopCondition& stop) {
  const std::size_t robots = request.plan.problem.robots().size();
  std::vector<std::vector<double>> costs;
  std::vector<std::vector<double>> times;
  std::vector<std::int64_t> importance;
  for (std::size_t task = 0; task < request.tasks.size(); ++task) {
    if (stop.met()) return std::nullopt;
    std::vector<double>& cost = costs.emplace_back(robots, core::kForever);
    importance.push_back(std::llround(request.weights[task] / kSameWeight));
    std::vector<double>& time = times.emplace_back(robots, core::kForever);
    for (std::size_t k = 0; k < request.tasks[task].robots.size(); ++k) {
      time[request.tasks[task].robots[k]] = arrivals[task][k];
      cost[request.tasks[task].robots[k]] = request.weights[task] * arrivals[task][k];
    }
  }
  const auto columns = core::assign(costs, importance, stop);
  if (!columns) return std::nullopt;
  std::vector<std::optional<Assigned>> all;
  for (std::size_t task = 0; task < costs.size(); ++task) {
    const auto robot = (*columns)[task];
    all.push_back(robot ? std::optional(Assigned{*robot, times[task][*robot]}) : std::nullopt);
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
      write_robot(json, robot, request.goals[**task]);
    } else {
      copy_json(json, robot);
    }
    ++task;
  }
  json.end_array();
}

}  // namespace

std::string write_assigned(const AssignRequest& request, const std::vector<std::optional<Assigned>>& assigned,
                           const std::vector<bool>& any_way) {
  const std::vector<core::Robot>& robots = request.plan.problem.robots();
  std::vector<std::optional<std::size_t>> task_of(robots.size());
  for (std::size_t task = 0; task < assigned.size(); ++task) {
    if (assigned[task]) task_of[assigned[task]->robot] = task;
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
    if (!assigned[task]) continue;
    json.begin_object().member("task", request.ids[task]).member("robot", robots[assigned[task]->robot].id);
    json.member("t_arrive", assigned[task]->t_arrive).end_object();
  }
  json.end_array().key("unassigned").begin_array();
  for (std::size_t task = 0; task < assigned.size(); ++task) {
    if (assigned[task]) continue;
    json.begin_object().member("task", request.ids[task]);
    json.member("reason", any_way[task] ? "no_robot" : "no_way").end_object();
  }
  json.end_array().end_object();
  return json.take();
}

}  // namespace fleetplan::api
