#include "core/advance/acceptable.h"

#include <algorithm>
#include <memory>
#include <variant>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/problem.h"

namespace fleetplan::core {

namespace {

/// A share of the radius: a disk that is clear of a wall by less has its centre in it, whatever
/// `start_overlap` allows.
constexpr double kCentre = 2e-3;

/// Seconds: an action that ends by so much after a time is under way then.
constexpr double kStillUnderWay = 1e-9;

bool drives(const Robot& robot) {
  return std::any_of(robot.committed.begin(), robot.committed.end(),
                     [](const Action& action) { return action.type == Action::Type::translate; });
}

/// Mends what the problem of the new request has for faults, until there are none.
class Mending {
 public:
  Mending(const FleetInMotion& fleet, const Judgement& judgement, std::vector<Robot>& robots,
          Motions& motions, Work& work)
      : fleet_(fleet),
        judgement_(judgement),
        robots_(robots),
        motions_(motions),
        work_(work),
        map_(judgement.map()),
        start_overlap_(judgement.options.start_overlap),
        reports_(judgement.reports_invalid) {}

  Circumstances run() {
    if (!map_) work_.look();
    // Robots that go on as planned could meet walls again.
    motions_.courses.clear();
    const std::vector<double> margins =
        margins_of(fleet_.robots, fleet_.executions, fleet_.moment, robots_, work_);
    while (map_ && !work_.met() && mend_all()) clear_commitments(robots_, margins, motions_, work_);
    return std::move(found_);
  }

 private:
  bool mend_all() {
    auto made = Problem::create(map_, robots_in_map(), conditions(), work_.reading());
    const auto* faults = std::get_if<ProblemFaults>(&made);
    if (faults == nullptr) return false;
    if (!faults->finished) work_.look();
    bool any = false;
    for (const ProblemFault& fault : faults->listed) any = mend(fault) || any;
    return any;
  }

  Pose read_back(const Pose& pose) const {
    return {judgement_.read_back(pose.position), normalize_angle(pose.theta)};
  }

  /// The robots as they are read again.
  std::vector<Robot> robots_in_map() const {
    std::vector<Robot> all;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      const Robot& next = robots_[k];
      if (work_.met_after(kWorkOfAnAction * (1 + next.committed.size() + next.goal_count()))) break;
      Robot robot = fleet_.robots[k];
      robot.previous.reset();
      robot.radius = next.radius;
      robot.start = read_back(next.start);
      robot.via = next.via;
      robot.goal = next.goal;
      for (Goal& goal : robot.via) goal.position = judgement_.read_back(goal.position);
      if (robot.goal) robot.goal->position = judgement_.read_back(robot.goal->position);
      robot.committed = next.committed;
      for (Action& action : robot.committed) {
        action.from = read_back(action.from);
        action.to = read_back(action.to);
      }
      all.push_back(std::move(robot));
    }
    return all;
  }

  ProblemConditions conditions() const {
    PlanOptions options = judgement_.options;
    options.start_overlap = start_overlap_;
    ProblemConditions conditions = conditions_of(options);
    conditions.zones = judgement_.zones;
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
        return allow_overlap(2.0 * judgement_.options.inflation - fault.gap);
      case Kind::start_in_obstacle:
        if (-fault.gap < (1.0 - kCentre) * fault.radius) {
          return allow_overlap(judgement_.options.inflation - fault.gap);
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
    Robot& a = robots_[fault.robot];
    Robot& b = robots_[fault.other];
    const bool some_drive = drives(a) || drives(b);
    bool any = false;
    for (Robot* robot : {&a, &b}) {
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

  const FleetInMotion& fleet_;
  const Judgement& judgement_;
  std::vector<Robot>& robots_;
  Motions& motions_;
  Work& work_;
  std::shared_ptr<const StaticMap> map_;
  double start_overlap_;
  bool reports_;  // robots whose starts are at fault
  Circumstances found_;
};

}  // namespace

Circumstances make_acceptable(const FleetInMotion& fleet, const Judgement& judgement,
                              std::vector<Robot>& next, Motions& motions, Work& work) {
  const bool any_observed =
      std::any_of(fleet.executions.begin(), fleet.executions.end(),
                  [](const Execution& execution) { return execution.measured || execution.reported; });
  Circumstances found;
  if (!any_observed) {
    found.unavoidable = collisions_of_commitments(next, motions.braking, work);
    // Robots that could not stop in time overlap later on, whether they are observed then or not.
    const bool any_overlap = std::any_of(found.unavoidable.listed.begin(), found.unavoidable.listed.end(),
                                         [](const Collision& collision) { return collision.t == 0.0; });
    if (!any_overlap) return found;
  }
  found = Mending(fleet, judgement, next, motions, work).run();
  found.unavoidable = collisions_of_commitments(next, motions.braking, work);
  return found;
}

}  // namespace fleetplan::core
