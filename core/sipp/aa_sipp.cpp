#include "core/sipp/aa_sipp.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Candidates between two looks at the clock.
constexpr int kStopStride = 32;

}  // namespace

SearchResult AaSipp::run(std::size_t robot, const Vertices& vertices, CostToGo& cost_to_go,
                         const SearchLimits& limits, const StopCondition& stop) {
  robot_ = robot;
  motion_ = &instance_.motion(robot);
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
  labels_.clear();
  ways_.clear();
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
  coarse_ = !thorough && limits_.dominance_slack > 0.0;
  const double reach = coarse_ ? limits_.dominance_slack * instance_.lattice().spacing() : 0.0;
  dominance_.begin(*motion_, motion_->translation_time(reach));
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
    if (expansions_ >= limits_.max_expansions) return Outcome::stopped;
    if (best_goal_will_do()) {
      settle(candidates_[static_cast<std::size_t>(best_goal_)]);
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
  dominance_.set_interval_count(intervals_.size());
  return known;
}

void AaSipp::add_start() {
  const int place = place_of(vertices_->start());
  const int interval = places_[static_cast<std::size_t>(place)].first_interval;
  if (places_[static_cast<std::size_t>(place)].interval_count == 0) return;
  if (intervals_[static_cast<std::size_t>(interval)].begin > 0.0) return;
  // Who need not go anywhere holds for ever, and is at rest from the beginning.
  const double t = is_final(place, interval) ? 0.0 : limits_.start_delay;
  if (!intervals_[static_cast<std::size_t>(interval)].contains(t)) return;
  const double heading = instance_.robot(robot_).start.theta;
  if (!(rank(place, interval, t, heading).cost < limits_.bound)) return;
  dominance_.add(interval, t, heading);
  labels_.push_back({t, heading, t, -1, place, interval});
  if (is_final(place, interval)) {
    goal_label_ = 0;
  } else {
    expand(0);
  }
}

double AaSipp::to_go(int place, double heading) const {
  if (place == goal_place_) {
    const auto& goal = *instance_.robot(robot_).goal;
    return goal.theta ? motion_->rotation_time(heading, *goal.theta) : 0.0;
  }
  const auto& estimate = places_[static_cast<std::size_t>(place)].estimate;
  return estimate.seconds + motion_->rotation_time(heading, estimate.heading);
}

AaSipp::Rank AaSipp::rank(int place, int interval, double arrival, double heading) const {
  const double h = to_go(place, heading);
  const double cost = std::max(arrival + h, release_);
  // At the goal, good enough is first: the order is flat while it is not free, and would leave it for last.
  if (is_final(place, interval)) return {cost / (1.0 + limits_.suboptimality), h, cost};
  return {std::max(arrival + limits_.heuristic_weight * h, release_), h, cost};
}

void AaSipp::push(const Candidate& candidate, const Rank& rank) {
  const int index = static_cast<int>(candidates_.size());
  candidates_.push_back(candidate);
  open_.push_back({rank.key, rank.h, index});
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
}

Standing AaSipp::standing_at(int label) const {
  const Label& l = labels_[static_cast<std::size_t>(label)];
  return {l.arrival, l.heading, l.parent >= 0, intervals_[static_cast<std::size_t>(l.interval)]};
}

Position AaSipp::position_of(int label) const {
  return places_[static_cast<std::size_t>(labels_[static_cast<std::size_t>(label)].place)].position;
}

bool AaSipp::is_final(int place, int interval) const {
  return place == goal_place_ && intervals_[static_cast<std::size_t>(interval)].end == kForever;
}

/// Is the best known way to the goal good enough by now?
bool AaSipp::best_goal_will_do() const {
  const double tolerated =
      limits_.suboptimality + limits_.suboptimality_growth * static_cast<double>(expansions_);
  return best_goal_ >= 0 && best_goal_cost_ <= (1.0 + tolerated) * open_.front().key;
}

void AaSipp::process(int index) {
  const double key = open_.front().key;
  std::pop_heap(open_.begin(), open_.end(), std::greater<>());
  open_.pop_back();
  const Candidate candidate = candidates_[static_cast<std::size_t>(index)];
  if (candidate.entry < 0) {
    time_move(candidate, key);
  } else if (!dominance_.dominated(candidate.entry)) {
    settle(candidate);
  }
}

void AaSipp::time_move(Candidate candidate, double key) {
  Way& way = ways_[static_cast<std::size_t>(candidate.way)];
  const bool shortcut = candidate.kind == Kind::shortcut;
  const bool seen = !shortcut || sees(way);
  const Move move = shortcut ? way.shortcut : way.local;
  const int place = way.place;
  const int interval = candidate.interval;
  const Label& via = labels_[static_cast<std::size_t>(way.via)];
  const Segment path{shortcut ? position_of(via.parent) : position_of(way.via),
                     places_[static_cast<std::size_t>(place)].position};
  if (candidate.leads) follow(candidate.way, interval + 1);
  // An arrival that dominates the optimistic one also dominates the way through the expanded label.
  if (redundant(interval, candidate.arrival, move.heading, key)) return;
  SafeInterval target = intervals_[static_cast<std::size_t>(interval)];
  const double useful_until = dominance_.needless_from(interval, move.heading);
  if (useful_until < target.end) {
    target.end = useful_until;
    pruned_ = pruned_ || coarse_;
  }
  const auto departure = seen ? timing_->earliest(move, path, target) : std::nullopt;
  const double optimistic = candidate.arrival;
  if (departure) {
    candidate.departure = *departure;
    candidate.arrival = *departure + move.duration;
    if (candidate.arrival <= optimistic + kSameTime) {
      dominance_.add(interval, candidate.arrival, move.heading);
      return settle(candidate);
    }
  }
  if (shortcut) offer(candidate.way, Kind::local, interval, false);
  if (!departure || redundant(interval, candidate.arrival, move.heading, key)) return;
  const Rank ranked = rank(place, interval, candidate.arrival, move.heading);
  if (!(ranked.cost < limits_.bound)) return;
  candidate.entry = dominance_.add(interval, candidate.arrival, move.heading);
  push(candidate, ranked);
  if (is_final(place, interval) && ranked.cost < best_goal_cost_) {
    best_goal_ = static_cast<int>(candidates_.size()) - 1;
    best_goal_cost_ = ranked.cost;
  }
}

/// Is an arrival there that makes this one needless, or good enough?
bool AaSipp::redundant(int interval, double arrival, double heading, double key) {
  if (dominance_.none_in(interval)) return false;
  const bool waiting = !thorough_ && key <= release_;  // while the goal is not even free, one label will do
  const bool dominated = waiting || dominance_.needless_from(interval, heading) <= arrival + kSameTime ||
                         (motion_->wait_before_move > 0.0 && dominance_.has(interval, arrival, heading));
  pruned_ = pruned_ || (dominated && (waiting || coarse_));
  return dominated;
}

void AaSipp::settle(const Candidate& candidate) {
  const Way& way = ways_[static_cast<std::size_t>(candidate.way)];
  const bool shortcut = candidate.kind == Kind::shortcut;
  const int parent = shortcut ? labels_[static_cast<std::size_t>(way.via)].parent : way.via;
  const int label = static_cast<int>(labels_.size());
  const double heading = (shortcut ? way.shortcut : way.local).heading;
  const int place = way.place;
  labels_.push_back({candidate.arrival, heading, candidate.departure, parent, place, candidate.interval});
  if (is_final(place, candidate.interval)) {
    goal_label_ = label;
  } else {
    expand(label);
  }
}

void AaSipp::expand(int label) {
  ++expansions_;
  const Label l = labels_[static_cast<std::size_t>(label)];
  const int vertex = places_[static_cast<std::size_t>(l.place)].vertex;
  const bool any_angle = instance_.options().any_angle;
  if (any_angle) shoot_at_goal(label);
  const int before =
      l.parent < 0
          ? -1
          : places_[static_cast<std::size_t>(labels_[static_cast<std::size_t>(l.parent)].place)].vertex;
  vertices_->for_each_neighbour(vertex, [&](int neighbour) {
    const int place = place_of(neighbour);
    if (places_[static_cast<std::size_t>(place)].interval_count == 0) return;
    const bool with_shortcut = any_angle && l.parent >= 0 && neighbour != before;
    follow(add_way(label, place, with_shortcut), places_[static_cast<std::size_t>(place)].first_interval);
  });
}

/// Where the goal is in sight, tries to go there at once, in the interval that it may stay in.
void AaSipp::shoot_at_goal(int label) {
  const int from = labels_[static_cast<std::size_t>(label)].place;
  if (from == goal_place_ || !places_[static_cast<std::size_t>(from)].estimate.straight) return;
  const Place& goal = places_[static_cast<std::size_t>(goal_place_)];
  offer(add_way(label, goal_place_, false), Kind::local, goal.first_interval + goal.interval_count - 1,
        false);
}

int AaSipp::add_way(int via, int place, bool with_shortcut) {
  const auto move_from = [&](int label) {
    const int from = places_[static_cast<std::size_t>(labels_[static_cast<std::size_t>(label)].place)].vertex;
    const Displacement d = vertices_->between(from, places_[static_cast<std::size_t>(place)].vertex);
    return timing_->move(standing_at(label), d.heading, d.length);
  };
  const int parent = labels_[static_cast<std::size_t>(via)].parent;
  ways_.push_back({move_from(via), with_shortcut ? move_from(parent) : Move{}, via, place,
                   with_shortcut ? Sight::unknown : Sight::blocked});
  return static_cast<int>(ways_.size()) - 1;
}

/// Is the shortcut free of obstacles?
bool AaSipp::sees(Way& way) {
  if (way.sight == Sight::unknown) {
    const int parent = labels_[static_cast<std::size_t>(way.via)].parent;
    const bool free = instance_.sight().may_sweep(
        position_of(parent), places_[static_cast<std::size_t>(way.place)].position, motion_->radius);
    way.sight = free ? Sight::free : Sight::blocked;
  }
  return way.sight == Sight::free;
}

/// Puts the first move into `interval` of the way's place, or a later one, on the open list.
void AaSipp::follow(int index, int interval) {
  const Way& way = ways_[static_cast<std::size_t>(index)];
  const Place& place = places_[static_cast<std::size_t>(way.place)];
  const int end = place.first_interval + place.interval_count;
  const bool shortcut = way.sight != Sight::blocked;
  const double local_latest = way.local.latest + way.local.duration;
  const double latest =
      shortcut ? std::max(local_latest, way.shortcut.latest + way.shortcut.duration) : local_latest;
  for (; interval < end && intervals_[static_cast<std::size_t>(interval)].begin <= latest; ++interval) {
    if (shortcut && offer(index, Kind::shortcut, interval, true)) return;
    if (offer(index, Kind::local, interval, true)) return;
  }
}

/// Puts a move on the open list with the earliest arrival it could have, unless it is impossible, too
/// expensive or dominated.
bool AaSipp::offer(int index, Kind kind, int interval, bool leads) {
  const Way& way = ways_[static_cast<std::size_t>(index)];
  const Move& move = kind == Kind::shortcut ? way.shortcut : way.local;
  const double departure = EdgeTiming::optimistic(move, intervals_[static_cast<std::size_t>(interval)]);
  if (departure == kForever) return false;
  const double arrival = departure + move.duration;
  const Rank ranked = rank(way.place, interval, arrival, move.heading);
  if (!(ranked.cost < limits_.bound)) return false;
  if (redundant(interval, arrival, move.heading, ranked.key)) return false;
  push({arrival, departure, index, interval, -1, kind, leads}, ranked);
  return true;
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
