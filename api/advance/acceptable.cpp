#include <algorithm>
#include <memory>
#include <variant>

#include "api/advance/advance_request.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/problem.h"

namespace fleetplan::api {

namespace {

using core::Action;
using core::ProblemFault;

/// A share of the radius: a disk that is clear of a wall by less has its centre in it, whatever
/// `start_overlap` allows.
constexpr double kCentre = 2e-3;

/// Seconds: an action that ends by so much after a time is under way then.
constexpr double kStillUnderWay = 1e-9;

bool drives(const core::Robot& robot) {
  return std::any_of(robot.committed.begin(), robot.committed.end(),
                     [](const Action& action) { return action.type == Action::Type::translate; });
}

/// What /v1/plan reads when this is written: rounded in the client's world.
core::Position read_back(const core::Position& position, const WorldFrame& frame) {
  return frame.to_world(position) - frame.origin;
}

core::Pose read_back(const core::Pose& pose, const WorldFrame& frame) {
  return {read_back(pose.position, frame), core::normalize_angle(pose.theta)};
}

/// Mends what the problem of the new request has for faults, until there are none.
class Mending {
 public:
  Mending(AdvanceRequest& request, std::vector<core::Robot>& robots, Motions& motions, core::MapCache* maps,
          core::Work& work)
      : request_(request),
        robots_(robots),
        motions_(motions),
        work_(work),
        map_(maps != nullptr ? maps->map_of(std::move(request.fleet.map->grid), work.reading())
                             : core::static_map(std::move(request.fleet.map->grid), work.reading())),
        start_overlap_(request.fleet.options.plan.start_overlap),
        reports_(request.fleet.options.invalid_robots == InvalidRobots::report) {}

  Circumstances run() {
    if (!map_) work_.look();
    // Robots that go on as planned could meet walls again.
    motions_.courses.clear();
    const std::vector<double> margins =
        margins_of(request_.robots, request_.executions, request_.moment, robots_, work_);
    while (map_ && !work_.met() && mend_all()) clear_commitments(robots_, margins, motions_, work_);
    return std::move(found_);
  }

 private:
  bool mend_all() {
    auto made = core::Problem::create(map_, robots_in_map(), conditions(), work_.reading());
    const auto* faults = std::get_if<core::ProblemFaults>(&made);
    if (faults == nullptr) return false;
    if (!faults->finished) work_.look();
    bool any = false;
    for (const ProblemFault& fault : faults->listed) any = mend(fault) || any;
    return any;
  }

  /// The robots as /v1/plan reads them.
  std::vector<core::Robot> robots_in_map() const {
    std::vector<core::Robot> all;
    const WorldFrame& frame = request_.fleet.map->frame;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      const core::Robot& next = robots_[k];
      if (work_.met_after(kWorkOfAnAction * (1 + next.committed.size() + next.goal_count()))) break;
      core::Robot robot = request_.fleet.robots[k].robot;
      robot.previous.reset();
      robot.radius = next.radius;
      robot.start = read_back(next.start, frame);
      robot.via = next.via;
      robot.goal = next.goal;
      for (core::Goal& goal : robot.via) goal.position = read_back(goal.position, frame);
      if (robot.goal) robot.goal->position = read_back(robot.goal->position, frame);
      robot.committed = next.committed;
      for (Action& action : robot.committed) {
        action.from = read_back(action.from, frame);
        action.to = read_back(action.to, frame);
      }
      all.push_back(std::move(robot));
    }
    return all;
  }

  core::ProblemConditions conditions() const {
    core::PlanOptions options = request_.fleet.options.plan;
    options.start_overlap = start_overlap_;
    core::ProblemConditions conditions = core::conditions_of(options);
    conditions.zones = request_.fleet.zones;
    conditions.list_faults_of_every_robot = true;
    return conditions;
  }

  /// Returns whether anything has changed. Faults of goals are the client's.
  bool mend(const ProblemFault& fault) {
    using Kind = ProblemFault::Kind;
    switch (fault.kind) {
      case Kind::committed_in_zone:
        return end_before(fault.robot, fault.t);
      case Kind::committed_collision:
        return fault.other == fault.robot ? end_before(fault.robot, fault.t) : stop_pair(fault);
      case Kind::starts_overlap:
        return allow_overlap(2.0 * request_.moment.inflation - fault.gap);
      case Kind::start_in_obstacle:
        if (-fault.gap < (1.0 - kCentre) * fault.radius) {
          return allow_overlap(request_.moment.inflation - fault.gap);
        }
        if (reports_) return false;
        reports_ = found_.some_in_walls = true;
        return true;
      case Kind::goal_in_obstacle:
      case Kind::goals_overlap:
        break;
    }
    return false;
  }

  /// Ends a commitment before the action that is under way at a time.
  bool end_before(std::size_t robot, double t) {
    std::vector<Action>& committed = robots_[robot].committed;
    if (committed.empty()) return false;
    const auto first = std::find_if(committed.begin(), committed.end(),
                                    [&](const Action& action) { return action.t_end > t + kStillUnderWay; });
    committed.erase(first == committed.end() ? std::prev(first) : first, committed.end());
    return true;
  }

  /// Nobody of the two drives.
  bool stop_pair(const ProblemFault& fault) {
    core::Robot& a = robots_[fault.robot];
    core::Robot& b = robots_[fault.other];
    const bool some_drive = drives(a) || drives(b);
    bool any = false;
    for (core::Robot* robot : {&a, &b}) {
      if (robot->committed.empty() || (some_drive && !drives(*robot))) continue;
      robot->committed.clear();
      any = true;
    }
    return any;
  }

  bool allow_overlap(double metres) {
    if (reports_ || metres <= start_overlap_) return false;
    start_overlap_ = metres;
    found_.start_overlap = metres;
    return true;
  }

  AdvanceRequest& request_;
  std::vector<core::Robot>& robots_;
  Motions& motions_;
  core::Work& work_;
  std::shared_ptr<const core::StaticMap> map_;
  double start_overlap_;
  bool reports_;  // robots whose starts are at fault
  Circumstances found_;
};

}  // namespace

Circumstances make_acceptable(AdvanceRequest& request, std::vector<core::Robot>& robots, Motions& motions,
                              core::MapCache* maps, core::Work& work) {
  const bool any_observed =
      std::any_of(request.executions.begin(), request.executions.end(),
                  [](const Execution& execution) { return execution.measured || execution.reported; });
  Circumstances found;
  if (!any_observed) {
    found.unavoidable = collisions_of_commitments(robots, motions.braking, work);
    // Robots that could not stop in time overlap later on, whether they are observed then or not.
    const bool any_overlap = std::any_of(found.unavoidable.listed.begin(), found.unavoidable.listed.end(),
                                         [](const Collision& collision) { return collision.t == 0.0; });
    if (!any_overlap) return found;
  }
  found = Mending(request, robots, motions, maps, work).run();
  found.unavoidable = collisions_of_commitments(robots, motions.braking, work);
  return found;
}

}  // namespace fleetplan::api
