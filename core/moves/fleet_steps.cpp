#include "core/moves/fleet_steps.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include "core/moves/lattice_steps.h"
#include "core/runtime/budget.h"

namespace fleetplan::core {

StepsOutcome FleetSteps::follow(const std::vector<std::size_t>& order,
                                const std::vector<std::size_t>& hopeless, const StopCondition& stop) {
  std::vector<bool> moves(reservations_.instance().size(), false);
  for (const std::size_t robot : order) moves[robot] = true;
  for (const std::size_t robot : hopeless) moves[robot] = false;
  std::vector<std::size_t> robots;
  for (const std::size_t robot : order) {
    if (moves[robot]) robots.push_back(robot);
  }
  bool others_move = false;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    others_move = others_move || (!moves[i] && reservations_.trajectory(i));
  }
  MethodCounts counts{.tried = std::ssize(robots)};
  const StopCondition part = after_share(stop, budget::kShareOfSteps);
  const FleetReservations::Snapshot before = reservations_.snapshot();
  StepsOutcome outcome = StepsOutcome::none;
  try {
    outcome = follow_until(robots, others_move, part);
  } catch (const std::bad_alloc&) {  // not granted to the job
    outcome = StepsOutcome::limited;
    on_places_.reset();
  }
  if (outcome == StepsOutcome::followed) counts.served = counts.tried;
  if (outcome == StepsOutcome::limited && robots.size() > PlaceSteps::kMaxRobots) {
    counts.could_not_serve = counts.tried;
  }
  progress_.count(Method::steps, counts);
  if (outcome == StepsOutcome::followed) {
    progress_.next_attempt();
    progress_.update();
    return outcome;
  }
  reservations_.restore(before);
  return part.met() ? StepsOutcome::cut_off : outcome;
}

StepsOutcome FleetSteps::follow_until(const std::vector<std::size_t>& robots, bool others_move,
                                      const StopCondition& stop) {
  std::optional<std::vector<Trajectory>> trajectories;
  if (!others_move) {
    trajectories =
        plan_on_lattice(reservations_, robots, random_, after_share(stop, budget::kShareOfLattice));
  }
  if (trajectories && follow_all(robots, std::move(*trajectories), stop)) return StepsOutcome::followed;
  PlaceSteps& places = on_places(robots);
  trajectories = places.run(stop);
  if (trajectories && follow_all(places.robots(), std::move(*trajectories), stop))
    return StepsOutcome::followed;
  return places.has_no_way() ? StepsOutcome::none : StepsOutcome::limited;
}

/// Returns whether nobody meets.
bool FleetSteps::follow_all(const std::vector<std::size_t>& robots, std::vector<Trajectory> trajectories,
                            const StopCondition& stop) {
  for (const std::size_t robot : robots) reservations_.remove(robot);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (stop.met() || !reservations_.conflicting_robots(robots[k], trajectories[k]).empty()) return false;
    reservations_.follow(robots[k], std::move(trajectories[k]));
  }
  return true;
}

/// The search for these robots, as far as it has come.
PlaceSteps& FleetSteps::on_places(const std::vector<std::size_t>& robots) {
  // All others stay, so the robots say who does.
  const bool is_known =
      on_places_ && std::is_permutation(robots.begin(), robots.end(), on_places_->robots().begin(),
                                        on_places_->robots().end());
  if (!is_known) on_places_.emplace(reservations_, robots, random_);
  return *on_places_;
}

}  // namespace fleetplan::core
