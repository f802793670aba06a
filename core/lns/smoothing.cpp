#include "core/lns/smoothing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <numbers>
#include <utility>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/model/objective_share.h"
#include "core/runtime/budget.h"
#include "core/sipp/timed_path.h"

namespace fleetplan::core {
namespace {

/// The least gains, seconds: of a change, and of one more stop, because a robot has to drive it.
constexpr double kLeastGainOfChange = 1e-4;
constexpr double kLeastGainOfStop = 0.01;
/// The longest step of a bend, in lattice spacings; the shortest one is 2^-kHalvings of it.
constexpr double kLongestStep = 2.0;
constexpr double kHalvings = 6.0;
/// The shares of the tries that insert a bend, and that remove one; the others move one.
constexpr double kInsertions = 0.2;
constexpr double kRemovals = 0.1;
/// Tries for each robot of a first plan.
constexpr int kBriefTries = 50;

/// The path of one robot while it is made shorter.
class Smoothing {
 public:
  Smoothing(const Instance& instance, const ReservationTable& table, std::size_t robot, Random& random,
            const StopCondition& stop)
      : itinerary_(instance.itinerary(robot)),
        objective_(instance.options().objective),
        longest_step_(kLongestStep * instance.lattice(robot).spacing()),
        path_(instance, table, robot, stop),
        random_(random) {}

  bool follow(const Trajectory& trajectory) { return path_.follow(trajectory); }

  void try_once() {
    const double kind = random_.unit();
    if (kind < kInsertions) {
      const std::size_t end = 1 + random_.below(path_.stop_count() - 1);
      const Segment move{path_.position(end - 1), path_.position(end)};
      const Position aside = step();  // drawn first: operands have no order
      replace(end, 0, move.at(random_.unit()) + aside, kLeastGainOfStop);
      return;
    }
    if (path_.stop_count() == 2) return;
    const std::size_t stop = 1 + random_.below(path_.stop_count() - 2);
    if (!path_.is_bend(stop)) return;
    if (kind < kInsertions + kRemovals) {
      replace(stop, 1, std::nullopt, kLeastGainOfChange);
    } else {
      replace(stop, 1, path_.position(stop) + step(), kLeastGainOfChange);
    }
  }

  double share(const Trajectory& trajectory) const { return share_of(itinerary_, objective_, trajectory); }
  /// By how much the share falls at least if the path costs so many seconds less.
  double share_of_seconds(double gain) const {
    const double cost = trajectory().cost;
    return least_share(itinerary_, objective_, cost) - least_share(itinerary_, objective_, cost - gain);
  }
  const Trajectory& trajectory() const { return path_.trajectory(); }
  std::int64_t timed() const { return path_.timed(); }

 private:
  Position step() {
    const double length = longest_step_ * power_of_two(-kHalvings * random_.unit());
    const double angle = 2.0 * std::numbers::pi * random_.unit();
    return length * unit_vector(angle);
  }

  void replace(std::size_t stop, std::size_t count, const std::optional<Position>& by, double gain) {
    const double max_share = share(trajectory()) - share_of_seconds(gain);
    path_.replace(stop, count, by, cost_with_share(itinerary_, objective_, max_share),
                  [&](const Trajectory& tried) { return share(tried) < max_share; });
  }

  const Itinerary& itinerary_;
  const PlanOptions::Objective objective_;
  const double longest_step_;  // metres
  TimedPath path_;
  Random& random_;
};

}  // namespace

Smoothed smooth(PlanState& state, std::size_t robot, const Trajectory& trajectory, int tries, Random& random,
                const StopCondition& stop) {
  FleetReservations& reservations = state.reservations();
  const IgnoredRobots itself(reservations, {robot});
  Smoothing smoothing(state.instance(), reservations.table(), robot, random, stop);
  Smoothed smoothed;
  const bool may_be_timed = smoothing.follow(trajectory);
  const double before = smoothing.trajectory().cost;
  for (int k = 0; may_be_timed && k < tries && !stop.met(); ++k) smoothing.try_once();
  smoothed.timed = smoothing.timed();
  if (!may_be_timed) return smoothed;
  const double gain = smoothing.share(trajectory) - smoothing.share(smoothing.trajectory());
  if (gain < smoothing.share_of_seconds(kLeastGainOfChange)) return smoothed;
  smoothed.trajectory = smoothing.trajectory();
  smoothed.trajectory->smoothed_by =
      trajectory.smoothed_by + std::max(0.0, before - smoothed.trajectory->cost);
  return smoothed;
}

bool smooth_briefly(PlanState& state, std::vector<std::size_t> robots, Random& random,
                    const StopCondition& stop, ProgressReport& progress) {
  FleetReservations& reservations = state.reservations();
  std::erase_if(robots, [&](std::size_t robot) { return reservations.trajectory(robot)->is_previous; });
  if (robots.empty() || !state.instance().options().smoothing) return false;
  MethodCounts counts{.tried = std::ssize(robots)};
  counts.could_not_serve = std::count_if(robots.begin(), robots.end(), [&](std::size_t robot) {
    return !may_smooth(state.instance().options()) || !TimedPath::may_be_timed(state.instance(), robot);
  });
  counts.served = counts.tried - counts.could_not_serve;
  progress.count(Method::smoothing, counts);
  if (counts.served == 0) return false;
  const StopCondition soon = after_share(stop, budget::kShareOfBriefSmoothing);
  if (soon.met()) return true;
  reservations.resume();
  try {
    for (const std::size_t robot : robots) {
      if (soon.met()) return true;
      Smoothed smoothed = smooth(state, robot, *reservations.trajectory(robot), kBriefTries, random, soon);
      if (smoothed.trajectory) reservations.follow(robot, std::move(*smoothed.trajectory));
    }
  } catch (const std::bad_alloc&) {  // not granted to the job
    return true;
  }
  return soon.met();
}

}  // namespace fleetplan::core
