#include "core/search/aa_sipp.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "core/geometry/angle.h"

namespace fleetplan::core {
namespace {

/// Arrivals and departures that differ by less are the same (seconds): rounding of sums of durations.
constexpr double kSameTime = 1e-11;
/// Candidates between two looks at the clock.
constexpr int kStopStride = 32;

}  // namespace

SearchResult AaSipp::run(std::size_t robot, const Vertices& vertices, CostToGo& cost_to_go,
                         const SearchLimits& limits, const StopCondition& stop) {
  robot_ = robot;
  motion_ = &fleet_.motion(robot);
  timing_.emplace(*motion_, table_, robot);
  vertices_ = &vertices;
  cost_to_go_ = &cost_to_go;
  stop_ = &stop;
  limits_ = limits;
  expansions_ = 0;
  place_of_vertex_.resize(std::max(place_of_vertex_.size(), static_cast<std::size_t>(vertices.count())), -1);
  Outcome outcome = search(false);
  if (outcome == Outcome::pruned && limits.thorough) outcome = search(true);
  SearchResult result;
  result.expansions = expansions_;
  result.complete = outcome != Outcome::stopped;
  if (outcome == Outcome::found) result.trajectory = extract();
  reset();
  return result;
}

void AaSipp::reset() {
  for (const Place& place : places_) place_of_vertex_[static_cast<std::size_t>(place.vertex)] = -1;
  places_.clear();
  intervals_.clear();
  labels_of_interval_.clear();
  labels_.clear();
  candidates_.clear();
  open_.clear();
  goal_label_ = -1;
  best_goal_ = -1;
  best_goal_cost_ = kForever;
  pruned_ = false;
}

AaSipp::Outcome AaSipp::search(bool thorough) {
  reset();
  thorough_ = thorough;
  goal_place_ = place_of(vertices_->goal());
  const Place& goal = places_[static_cast<std::size_t>(goal_place_)];
  if (goal.interval_count == 0) return Outcome::exhausted;
  const SafeInterval& last =
      intervals_[static_cast<std::size_t>(goal.first_interval + goal.interval_count - 1)];
  if (last.end < kForever) return Outcome::exhausted;
  release_ = last.begin;
  add_start();
  for (int step = 1; goal_label_ < 0; ++step) {
    if (open_.empty()) return pruned_ ? Outcome::pruned : Outcome::exhausted;
    if (step % kStopStride == 0 && stop_->met()) return Outcome::stopped;
    if (best_goal_will_do()) {
      settle(candidates_[static_cast<std::size_t>(best_goal_)], best_goal_cost_);
    } else {
      process(open_.front().candidate);
    }
  }
  return Outcome::found;
}

int AaSipp::place_of(int vertex) {
  int& known = place_of_vertex_[static_cast<std::size_t>(vertex)];
  if (known >= 0) return known;
  known = static_cast<int>(places_.size());
  const Position position = vertices_->position(vertex);
  const auto safe = table_.safe_intervals(robot_, position);
  CostToGo::Estimate estimate;
  if (vertex != vertices_->goal()) estimate = cost_to_go_->from(vertex, *stop_);
  places_.push_back(
      {vertex, position, estimate, static_cast<int>(intervals_.size()), static_cast<int>(safe.size())});
  intervals_.insert(intervals_.end(), safe.begin(), safe.end());
  labels_of_interval_.resize(intervals_.size(), -1);
  return known;
}

void AaSipp::add_start() {
  const int place = place_of(vertices_->start());
  const int interval = places_[static_cast<std::size_t>(place)].first_interval;
  if (places_[static_cast<std::size_t>(place)].interval_count == 0) return;
  if (intervals_[static_cast<std::size_t>(interval)].begin > 0.0) return;
  if (!intervals_[static_cast<std::size_t>(interval)].contains(limits_.hold)) return;
  const double heading = fleet_.robot(robot_).start.theta;
  const Candidate start{limits_.hold, limits_.hold, heading,     -1,    -1,
                        place,        interval,     Kind::timed, false, false};
  push(start, rank(start));
}

double AaSipp::to_go(int place, double heading) const {
  if (place == goal_place_) {
    const auto& goal = *fleet_.robot(robot_).goal;
    return goal.theta ? motion_->rotation_time(heading, *goal.theta) : 0.0;
  }
  const auto& estimate = places_[static_cast<std::size_t>(place)].estimate;
  return estimate.seconds + motion_->rotation_time(heading, estimate.heading);
}

AaSipp::Rank AaSipp::rank(const Candidate& candidate) const {
  const double h = to_go(candidate.place, candidate.heading);
  const double cost = std::max(candidate.arrival + h, release_);
  // At the goal, good enough is first: the order is flat while it is not free, and would leave it for last.
  if (is_final(candidate.place, candidate.interval)) return {cost / (1.0 + limits_.suboptimality), h, cost};
  return {std::max(candidate.arrival + limits_.greed * h, release_), h, cost};
}

void AaSipp::push(const Candidate& candidate, const Rank& rank) {
  if (!(rank.cost < limits_.bound)) return;
  candidates_.push_back(candidate);
  const int index = static_cast<int>(candidates_.size()) - 1;
  if (candidate.kind == Kind::timed && rank.cost < best_goal_cost_ &&
      is_final(candidate.place, candidate.interval)) {
    best_goal_ = index;
    best_goal_cost_ = rank.cost;
  }
  open_.push_back({rank.key, rank.h, index});
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
}

Standing AaSipp::standing_at(int label) const {
  const Label& l = labels_[static_cast<std::size_t>(label)];
  return {l.arrival, l.heading, l.parent >= 0, intervals_[static_cast<std::size_t>(l.interval)]};
}

Move AaSipp::move_to(int label, int place, int interval) const {
  const int from = labels_[static_cast<std::size_t>(label)].place;
  Move move;
  move.path = {places_[static_cast<std::size_t>(from)].position,
               places_[static_cast<std::size_t>(place)].position};
  const Position d = move.path.to - move.path.from;
  move.heading = std::atan2(d.y(), d.x());
  move.duration = motion_->translation_time(d.norm());
  move.target = intervals_[static_cast<std::size_t>(interval)];
  return move;
}

/// Is the best known way to the goal good enough by now?
bool AaSipp::best_goal_will_do() const {
  const double tolerated = limits_.suboptimality + limits_.impatience * static_cast<double>(expansions_);
  return best_goal_ >= 0 && best_goal_cost_ <= (1.0 + tolerated) * open_.front().key;
}

void AaSipp::process(int index) {
  const double key = open_.front().key;
  std::pop_heap(open_.begin(), open_.end(), std::greater<>());
  open_.pop_back();
  Candidate candidate = candidates_[static_cast<std::size_t>(index)];
  if (candidate.kind == Kind::timed) return settle(candidate, key);

  const Move move = move_to(candidate.from, candidate.place, candidate.interval);
  const bool from_parent = candidate.kind == Kind::from_parent;
  const bool seen = !from_parent || fleet_.sight().may_sweep(move.path.from, move.path.to, motion_->radius);
  const auto [via, place, interval] = std::tuple(candidate.via, candidate.place, candidate.interval);
  if (candidate.leads) follow(via, place, interval + 1, candidate.blocked || !seen);  // later intervals
  // A label that dominates the optimistic arrival also dominates the way through the expanded label.
  if (redundant(interval, candidate.arrival, candidate.heading, key)) return;
  const auto departure = seen ? timing_->earliest(standing_at(candidate.from), move) : std::nullopt;
  const double optimistic = candidate.arrival;
  if (departure) {
    candidate.departure = *departure;
    candidate.arrival = *departure + move.duration;
    candidate.kind = Kind::timed;
    if (candidate.arrival <= optimistic + kSameTime) return settle(candidate, key);
  }
  if (from_parent) offer(Kind::local, via, place, interval, false, true);
  if (!departure) return;
  push(candidate, rank(candidate));
}

bool AaSipp::is_final(int place, int interval) const {
  return place == goal_place_ && intervals_[static_cast<std::size_t>(interval)].end == kForever;
}

/// Is a label there that makes this one needless, or good enough?
bool AaSipp::redundant(int interval, double arrival, double heading, double key) {
  const int first = labels_of_interval_[static_cast<std::size_t>(interval)];
  if (first < 0) return false;
  if (!thorough_ &&
      key <= release_) {  // while the goal is not even free, one label for each interval will do
    pruned_ = true;
    return true;
  }
  for (int l = first; l >= 0;) {
    const Label& label = labels_[static_cast<std::size_t>(l)];
    if (label.arrival + motion_->rotation_time(label.heading, heading) <= arrival + kSameTime) return true;
    l = label.next;
  }
  return false;
}

void AaSipp::settle(const Candidate& candidate, double key) {
  int& first = labels_of_interval_[static_cast<std::size_t>(candidate.interval)];
  if (redundant(candidate.interval, candidate.arrival, candidate.heading, key)) return;
  const int label = static_cast<int>(labels_.size());
  labels_.push_back({candidate.arrival, candidate.heading, candidate.departure, candidate.from,
                     candidate.place, candidate.interval, first});
  first = label;
  if (is_final(candidate.place, candidate.interval)) {
    goal_label_ = label;
    return;
  }
  expand(label);
}

void AaSipp::expand(int label) {
  ++expansions_;
  const int place = labels_[static_cast<std::size_t>(label)].place;
  if (fleet_.options().any_angle) shoot_at_goal(label);
  vertices_->for_each_neighbour(places_[static_cast<std::size_t>(place)].vertex, [&](int vertex) {
    const int target = place_of(vertex);
    follow(label, target, places_[static_cast<std::size_t>(target)].first_interval, false);
  });
}

/// Where the goal is in sight, tries to go there at once, in the interval that it may stay in.
void AaSipp::shoot_at_goal(int label) {
  const int from = labels_[static_cast<std::size_t>(label)].place;
  if (from == goal_place_ || !places_[static_cast<std::size_t>(from)].estimate.straight) return;
  const Place& goal = places_[static_cast<std::size_t>(goal_place_)];
  offer(Kind::local, label, goal_place_, goal.first_interval + goal.interval_count - 1, false, true);
}

/// Puts the first way into `interval` of the place, or a later one, on the open list.
void AaSipp::follow(int via, int place, int interval, bool blocked) {
  const Place& target = places_[static_cast<std::size_t>(place)];
  const int end = target.first_interval + target.interval_count;
  const bool parent =
      fleet_.options().any_angle && !blocked && labels_[static_cast<std::size_t>(via)].parent >= 0;
  for (; interval < end; ++interval) {
    const Offer shortcut =
        parent ? offer(Kind::from_parent, via, place, interval, true, blocked) : Offer::too_late;
    if (shortcut == Offer::made) return;
    const Offer local = offer(Kind::local, via, place, interval, true, blocked);
    if (local == Offer::made || (local == Offer::too_late && shortcut == Offer::too_late)) return;
  }
}

/// Puts a move on the open list with the earliest arrival it could have, unless it is impossible or
/// dominated; too late if that holds for all later intervals as well.
AaSipp::Offer AaSipp::offer(Kind kind, int via, int place, int interval, bool leads, bool blocked) {
  const int from = kind == Kind::from_parent ? labels_[static_cast<std::size_t>(via)].parent : via;
  if (labels_[static_cast<std::size_t>(from)].place == place) return Offer::too_late;
  const Standing standing = standing_at(from);
  const Move move = move_to(from, place, interval);
  if (move.target.begin - move.duration > standing.interval.end) return Offer::too_late;
  const auto departure = timing_->optimistic(standing, move);
  if (!departure) return Offer::useless;
  const double arrival = *departure + move.duration;
  const Candidate candidate{arrival, *departure, move.heading, from,  via,
                            place,   interval,   kind,         leads, blocked};
  const Rank ranked = rank(candidate);
  if (redundant(interval, arrival, move.heading, ranked.key)) return Offer::useless;
  push(candidate, ranked);
  return Offer::made;
}

Trajectory AaSipp::extract() const {
  std::vector<const Label*> way;
  for (int l = goal_label_; l >= 0; l = labels_[static_cast<std::size_t>(l)].parent) {
    way.push_back(&labels_[static_cast<std::size_t>(l)]);
  }
  std::reverse(way.begin(), way.end());
  Trajectory trajectory;
  trajectory.start = places_[static_cast<std::size_t>(way.front()->place)].position;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Position& to = places_[static_cast<std::size_t>(way[i]->place)].position;
    const bool goes_on = i > 1 && way[i]->departure == way[i - 1]->arrival &&
                         angle_between(way[i - 1]->heading, way[i]->heading) <= kSameHeading;
    if (goes_on) {
      trajectory.moves.back().path.to = to;
      trajectory.moves.back().t_end = way[i]->arrival;
    } else {
      const Position& from = places_[static_cast<std::size_t>(way[i - 1]->place)].position;
      trajectory.moves.push_back({{from, to}, way[i]->departure, way[i]->arrival});
    }
  }
  const Label& last = *way.back();
  trajectory.cost = last.arrival + to_go(last.place, last.heading);
  return trajectory;
}

}  // namespace fleetplan::core
