#include "core/sipp/vertices.h"

#include <optional>

#include "core/geometry/tolerance.h"
#include "core/instance/instance.h"

namespace fleetplan::core {
namespace {

/// Comparisons of own vertices and links between two checks of the stop condition.
constexpr std::size_t kWorkBetweenPolls = 16 * 1024;

/// As many as it takes to add one more own vertex, about.
std::size_t work_to_add_to(const OwnVertices& own) {
  const auto count = static_cast<std::size_t>(own.end() - own.first());
  return 1 + 2 * count + (count == 0 ? 0 : own.links(own.end() - 1).size());
}

}  // namespace

Vertices::Vertices(const Instance& instance, std::size_t robot, std::size_t stage)
    : times_(instance.stages(robot)[stage].motion, instance.stages(robot)[stage].zones.get()),
      zones_(instance.stages(robot)[stage].zones.get()),
      lattice_(instance.lattice(robot)),
      free_space_(*instance.stages(robot)[stage].free_space),
      finer_(free_space_.finer()),
      any_angle_(instance.options().any_angle),
      own_(instance, robot, stage) {}

Vertices::Vertices(const Instance& instance, std::size_t robot, const Goal& goal)
    : Vertices(instance, robot, std::size_t{0}) {
  goals_.push_back({own_.add_goal(robot, goal.position), goal.theta});
}

void Vertices::replace_start(const Instance& instance, std::size_t robot) {
  own_.remove_start();
  const int goal = goals_.front().vertex;
  const bool at_goal = is_same_position(instance.itinerary(robot).pose.position, position(goal));
  start_ = at_goal ? goal : own_.add_start(robot);
}

Vertices::Vertices(const Instance& instance, std::size_t robot, std::size_t stage, const StopCondition& stop)
    : Vertices(instance, robot, stage) {
  const RobotStages& stages = instance.stages(robot);
  const Load& load = stages[stage].load;
  if (stages[0].load == load) start_ = own_.add_start(robot);
  const Itinerary& itinerary = instance.itinerary(robot);
  // Committed actions that end in contact with the goal end there: a service goes on, without a move.
  double same = instance.robot(robot).committed.empty() ? kSamePosition : kContactTolerance;
  std::size_t work = 0;  // since the last check
  for (std::size_t k = 0; k < itinerary.goals.size(); ++k) {
    work += work_to_add_to(own_);
    if (work >= kWorkBetweenPolls) {
      work = 0;
      if (stop.met()) {
        finished_ = false;
        return;
      }
    }
    const Goal& goal = itinerary.goals[k];
    if (goal.anywhere) {  // wherever the robot comes to this stage
      goals_.push_back({goals_.empty() ? start_ : goals_.back().vertex, std::nullopt});
      continue;
    }
    const bool is_here = stages[k].load == load || stages[k + 1].load == load;
    const bool at_start = start_ >= 0 && (goal.position - itinerary.pose.position).norm() <= same;
    const int vertex = at_start ? start_ : is_here ? own_.add_goal(robot, goal.position) : -1;
    goals_.push_back({vertex, goal.theta});
    same = kSamePosition;
  }
}

bool Vertices::is_free(int from, int to) const {
  if (own_.contains(from) || own_.contains(to)) return own_.is_free(from, to);
  return free_space_.may_sweep(position(from), position(to), motion().radius);
}

}  // namespace fleetplan::core
