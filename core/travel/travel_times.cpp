#include "core/travel/travel_times.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>

#include "core/geometry/segment.h"
#include "core/instance/instance.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/memory_account.h"
#include "core/sipp/aa_sipp.h"
#include "core/sipp/search_space.h"

namespace fleetplan::core {
namespace {

/// Columns that are computed until others may have the turn: enough for all threads.
constexpr std::size_t kColumnsOfARound = 16;
/// The limits of a search that finds the cheapest path that any of the planner's searches can be expected to
/// find.
constexpr SearchLimits kExact{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};

double metres_of(const Trajectory& trajectory) {
  double metres = 0.0;
  for (const TimedSegment& move : trajectory.moves) metres += move.path.length();
  return metres;
}

/// What one thread needs for the ways of a column.
class Travels {
 public:
  Travels(const Problem& problem, const PlanOptions& options, const Instance* like, const StopCondition& stop)
      : instance_(like == nullptr ? Instance(problem, options, stop)
                                  : Instance(problem, options, like->fixed_reservations(), stop)),
        nobody_(problem.grid().width(), problem.grid().height(), problem.grid().width(),
                std::vector<LargestDisk>(problem.robots().size(), instance_.largest_disk(0))),
        search_(nobody_) {}

  const Instance& instance() const { return instance_; }

  /// Returns the ways of a column; they must not be used if `stop` is met.
  std::vector<std::optional<Travel>> column(const TravelQuestions::Column& asked,
                                            const std::vector<bool>& any_heading, const StopCondition& stop) {
    std::vector<std::optional<Travel>> ways(asked.robots.size());
    if (asked.robots.empty() || !instance_.fits_at(asked.robots.front(), asked.goal.position)) return ways;
    SearchSpace space(instance_, asked.robots.front(), asked.goal);
    for (std::size_t k = 0; k < ways.size() && !stop.met(); ++k) {
      const std::size_t robot = asked.robots[k];
      space.begin_at(robot, any_heading[robot]);
      const auto way = this->way(space, stop);
      if (way && way->seconds < instance_.longest_plan(robot)) ways[k] = way;
    }
    return ways;
  }

 private:
  std::optional<Travel> way(SearchSpace& space, const StopCondition& stop) {
    const Vertices& vertices = space.vertices();
    const double heading = vertices.start_pose().theta;
    const Vertices::GoalPose& goal = vertices.goals().front();
    if (vertices.start() == goal.vertex) {
      const bool turns = goal.heading && !space.any_heading_at_start();
      return Travel{turns ? vertices.rotation_time(goal.vertex, heading, *goal.heading) : 0.0, 0.0};
    }
    CostToGo& costs = space.cost_to_go(0);
    const CostToGo::Estimate estimate = costs.from(vertices.start(), stop);
    // Of a search that was stopped, the estimate is none of a way.
    if (estimate.least() == kForever || stop.met()) return std::nullopt;
    const double seconds =
        space.any_heading_at_start() ? estimate.least() : estimate.with_rotation(heading, vertices.motion());
    // In zones that limit speeds, the estimate is none of a whole way.
    const bool is_whole = !vertices.limit_speeds();
    const SearchResult found = search_.run(space, kExact, stop);
    if (found.trajectory && (!is_whole || found.trajectory->cost <= seconds)) {
      return Travel{found.trajectory->cost, metres_of(*found.trajectory)};
    }
    if (!is_whole) return std::nullopt;
    return Travel{seconds, costs.metres(vertices.start())};
  }

  const Instance instance_;
  const ReservationTable nobody_;
  AaSipp search_;
};

}  // namespace

std::optional<TravelAnswers> travel_times(const Problem& problem, const PlanOptions& options,
                                          const TravelQuestions& questions, const StopCondition& stop,
                                          Executor& executor, const std::function<bool()>& go_on) {
  const StopCondition patience = stop.despite_memory();
  MemoryAccount* account = MemoryScope::current();
  TravelAnswers answers(questions.columns.size());
  std::array<std::unique_ptr<Travels>, kColumnsOfARound> threads;  // by column of a round
  threads.front() = std::make_unique<Travels>(problem, options, nullptr, patience);
  const Instance* like = &threads.front()->instance();
  std::atomic<bool> is_cut = false;
  for (std::size_t first = 0; first < answers.size() && !is_cut; first += kColumnsOfARound) {
    if (go_on && !go_on()) return std::nullopt;
    executor.run(std::min(kColumnsOfARound, answers.size() - first), [&](std::size_t k) {
      const MemoryScope scope(account);
      if (patience.met()) is_cut = true;
      if (is_cut) return;
      if (!threads[k]) threads[k] = std::make_unique<Travels>(problem, options, like, patience);
      answers[first + k] = threads[k]->column(questions.columns[first + k], questions.any_heading, patience);
      if (patience.met()) is_cut = true;
    });
  }
  if (is_cut) return std::nullopt;
  return answers;
}

}  // namespace fleetplan::core
