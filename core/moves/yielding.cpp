#include "core/moves/yielding.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace fleetplan::core {
namespace {

bool is_yielding(const Itinerary& itinerary) { return itinerary.yields() && !itinerary.is_invalid; }

/// From when on a robot that yields has served its own goals by its trajectory, seconds; none if it does not.
std::optional<double> done_from(const FleetReservations& reservations, std::size_t robot) {
  const Itinerary& itinerary = reservations.instance().itinerary(robot);
  const std::size_t own_goals = itinerary.own_goal_count();
  if (itinerary.first_goal >= own_goals) return itinerary.t_begin;
  const std::vector<Visit>& visits = reservations.trajectory(robot)->visits;
  if (visits.empty() || visits.back().goal + 1 < own_goals) return std::nullopt;
  return visits.back().t_leave;
}

}  // namespace

bool any_yields(const Instance& instance) {
  return std::any_of(instance.itineraries().begin(), instance.itineraries().end(), is_yielding);
}

SearchResult plan_past_yielding(PlanState& state, std::size_t robot, const SearchSettings& settings,
                                const StopCondition& stop) {
  FleetReservations& reservations = state.reservations();
  const Instance& instance = state.instance();
  std::vector<std::size_t> shortened;
  for (std::size_t other = 0; other < instance.size(); ++other) {
    if (other == robot || !is_yielding(instance.itinerary(other)) || !reservations.trajectory(other))
      continue;
    const auto rests_from = done_from(reservations, other);
    if (!rests_from) continue;
    reservations.shorten(other, *rests_from + instance.options().start_safe_interval);
    shortened.push_back(other);
  }
  if (shortened.empty()) return {};
  SearchResult result = state.search(robot, settings, stop);
  for (const std::size_t other : shortened) reservations.lengthen(other);
  return result;
}

SearchResult plan_making_way(PlanState& state, std::size_t robot, std::size_t other,
                             const SearchSettings& settings, const StopCondition& stop) {
  FleetReservations& reservations = state.reservations();
  const Trajectory followed = *reservations.trajectory(robot);
  const std::vector<Goal>& goals = state.instance().itinerary(other).goals;
  const auto distance = [&](const Goal& goal) { return (goal.position - followed.end()).squaredNorm(); };
  const auto nearest = std::min_element(
      goals.begin(), goals.end(), [&](const Goal& a, const Goal& b) { return distance(a) < distance(b); });
  reservations.remove(robot);
  reservations.reserve_goal(other, static_cast<std::size_t>(nearest - goals.begin()));
  SearchResult result = state.search(robot, settings, stop);
  reservations.remove(other);
  reservations.follow(robot, followed);
  return result;
}

bool makes_way(const FleetReservations& reservations, std::size_t robot) {
  if (!reservations.instance().itinerary(robot).yields() || !reservations.trajectory(robot)) return false;
  const std::vector<TimedMove>& moves = reservations.trajectory(robot)->moves;
  const auto done = done_from(reservations, robot);
  return done && !moves.empty() && moves.back().t_start >= *done;
}

}  // namespace fleetplan::core
