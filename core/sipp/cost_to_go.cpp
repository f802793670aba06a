#include "core/sipp/cost_to_go.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "core/geometry/tolerance.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {
namespace {

/// Expansions between two checks of the stop condition, of each search.
constexpr std::size_t kStopStride = 64;
constexpr std::size_t kTimesStopStride = 256;
/// The share, of what any-angle moves shorten lattice moves at most, that is expected. With none, ways cost
/// up to 0.3 % more in offices; with all of it, the search takes more than twice as many expansions.
constexpr double kShortened = 0.25;

}  // namespace

TimesFromStart::TimesFromStart(const Vertices& vertices, int start, int goal)
    : vertices_(vertices),
      goal_(goal),
      goal_position_(vertices.position(goal)),
      times_(static_cast<std::size_t>(vertices.count())) {
  open(start, 0.0F);
}

std::optional<bool> TimesFromStart::reach_goal(std::int64_t max_expansions, const StopCondition& stop) {
  StopStride stride = StopStride::from_first(stop, kTimesStopStride);
  for (std::int64_t count = 0; !reached_goal_; ++count) {
    if (open_.empty()) return false;
    if (count >= max_expansions || stride.met_at_step()) return std::nullopt;
    ++expansions_;
    const Open best = open_.pop();
    if (best.seconds > time(best.vertex)) continue;
    reached_goal_ = best.vertex == goal_;
    if (!reached_goal_) expand(best);
  }
  open_ = {};
  return true;
}

void TimesFromStart::expand(const Open& best) {
  const Position here = vertices_.position(best.vertex);
  const double speed = vertices_.times().linear_speed(here);
  const Lattice& lattice = vertices_.lattice();
  const bool on_lattice = best.vertex < lattice.vertex_count();
  const auto after_one_step = static_cast<float>(best.seconds + lattice.spacing() / speed);
  vertices_.for_each_neighbour(best.vertex, [&](int neighbour) {
    const bool is_step = on_lattice && neighbour < lattice.vertex_count();
    if (time(neighbour) <= (is_step ? after_one_step : best.seconds)) return;
    if (!vertices_.allow(best.vertex, neighbour)) return;
    const double length = (vertices_.position(neighbour) - here).norm();
    const auto through = static_cast<float>(best.seconds + length / speed);
    if (through < time(neighbour)) open(neighbour, through);
  });
}

void TimesFromStart::open(int vertex, float seconds) {
  time(vertex) = seconds;
  open_.push(static_cast<float>(seconds + to_goal(vertex)), {seconds, vertex});
}

double TimesFromStart::to_goal(int vertex) const {
  return vertices_.body().cruise_time((vertices_.position(vertex) - goal_position_).norm());
}

/// Let T be the time of the way to the goal that was found; no way is faster. So the time to any vertex is at
/// least T minus the time of a straight line from the vertex to the goal.
double TimesFromStart::at_least(int vertex) {
  if (!reached_goal_) return 0.0;
  return std::clamp<double>(time(goal_) - to_goal(vertex), 0.0, time(vertex));
}

class CostToGo::BackwardSearch {
 public:
  BackwardSearch(const Vertices& vertices, std::size_t goal)
      : body_(vertices.body()),
        vertices_(vertices),
        goal_(vertices.goals()[goal].vertex),
        goal_heading_(vertices.goals()[goal].heading),
        start_(goal == 0 ? vertices.start() : vertices.goals()[goal - 1].vertex),
        start_position_(start_ >= 0 ? vertices.position(start_) : Position(0.0, 0.0)),
        shortening_(vertices.any_angle() ? 1.0 - kShortened * (1.0 - vertices.lattice().least_straight())
                                         : 1.0),
        nodes_(static_cast<std::size_t>(vertices.count())),
        reverse_seconds_(body_.may_reverse ? static_cast<std::size_t>(vertices.count()) : 0),
        first_start_vertex_(vertices.count()) {
    if (start_ >= 0) from_start_.emplace(vertices, start_, goal_);
  }

  void replace_start() {
    nodes_.grow(static_cast<std::size_t>(vertices_.count()));
    if (body_.may_reverse) reverse_seconds_.grow(static_cast<std::size_t>(vertices_.count()));
    for (int vertex = first_start_vertex_; vertex < vertices_.count(); ++vertex) {
      node(vertex) = Node();
      set_none(vertex);
    }
    start_known_ = first_start_vertex_ == vertices_.count();
  }

  Estimate from(int vertex, const StopCondition& stop) {
    if (vertex >= first_start_vertex_ && !start_known_) estimate_start(stop);
    Estimate straight;
    straight.seconds = kForever;
    if (vertices_.any_angle() && goal_in_sight(vertex)) {
      straight = via(vertex, goal_);
      straight.straight = true;
      if (!is_slowed(vertex, goal_)) return straight;
    }
    const Node& n = node(vertex);
    if (!settle(vertex, stop)) return has_begun_ && open_.empty() ? straight : via(vertex, goal_);
    if (straight.straight && straight.least() <= least(n, vertex)) return straight;
    return {n.seconds, heading(vertex), straight.straight, reverse_seconds(vertex)};
  }

  std::optional<bool> reaches(int vertex, std::int64_t max_expansions, const StopCondition& stop) {
    if (vertices_.any_angle() && goal_in_sight(vertex)) return true;
    if (vertex == start_) return from_start_->reach_goal(max_expansions, stop);
    begin(stop);
    if (!has_begun_) return std::nullopt;
    const Node& n = node(vertex);
    const std::int64_t last = expansions_ + max_expansions;
    StopStride stride = StopStride::from_first(stop, kStopStride);
    while (n.state != State::closed) {
      if (open_.empty()) return false;
      if (expansions_ >= last || stride.met_at_step()) return std::nullopt;
      expand_best();
    }
    return n.seconds < kForever;
  }

  std::vector<int> way(int vertex) {
    if (vertices_.any_angle() && goal_in_sight(vertex) && !is_slowed(vertex, goal_)) return {goal_};
    std::vector<int> way;
    // Bounded: the way has been found.
    for (int here = vertex; here != goal_ && node(here).state == State::closed; here = way.back()) {
      way.push_back(node(here).next);
    }
    return way;
  }

  double metres(int vertex) {
    double length = 0.0;
    for (const int next : way(vertex)) {
      length += vertices_.between(vertex, next).length;
      vertex = next;
    }
    return length;
  }

  std::int64_t expansions() const { return expansions_ + (from_start_ ? from_start_->expansions() : 0); }
  std::size_t bytes() const {
    return nodes_.bytes() + reverse_seconds_.bytes() + (from_start_ ? from_start_->bytes() : 0);
  }

 private:
  enum class State : std::uint8_t { unseen, open, closed };
  struct Node {
    double seconds = 0.0;
    std::int32_t next = -1;  // the vertex at which the first translation ends
    State state = State::unseen;
    bool sight_known = false;
    bool in_sight = false;
  };
  struct Open {
    double f;
    double seconds;
    std::int32_t vertex;
    bool operator>(const Open& other) const { return f != other.f ? f > other.f : vertex > other.vertex; }
  };

  Node& node(int vertex) { return nodes_[static_cast<std::size_t>(vertex)]; }
  /// Of the first translation from a vertex that was reached, forwards.
  double heading(int vertex) { return vertices_.between(vertex, node(vertex).next).heading; }
  double reverse_seconds(int vertex) {
    return body_.may_reverse ? reverse_seconds_[static_cast<std::size_t>(vertex)] : kForever;
  }
  /// The cost to go from a vertex that was reached, forwards or backwards, whichever is less; seconds.
  double least(const Node& node, int vertex) { return std::min(node.seconds, reverse_seconds(vertex)); }
  void set(Node& node, int vertex, int next, const Estimate& estimate);
  void set_none(int vertex);
  void estimate_start(const StopCondition& stop);
  bool estimate_start(int vertex, const StopCondition& stop);
  bool settle(int vertex, const StopCondition& stop);
  void begin(const StopCondition& stop);
  double seconds_from_start(int vertex);
  double translation_time(int from, int to, double length) const {
    return vertices_.times().translation_time(length, [&] {
      return Segment{vertices_.position(from), vertices_.position(to)};
    });
  }
  Estimate via(int vertex, int next);
  void add_onward(Estimate& estimate, int next, double length);
  bool goal_in_sight(int vertex);
  bool is_slowed(int vertex, int next) const;
  void relax(int vertex, int next);
  void relax_neighbours(int vertex, int next);
  void close(int vertex);
  void expand_best();

  const Body& body_;
  const Vertices& vertices_;
  const int goal_;
  const std::optional<double> goal_heading_;
  const int start_;  // or the goal before; the search is directed there; -1: in all directions
  const Position start_position_;
  std::optional<TimesFromStart> from_start_;
  const double shortening_;  // of lattice moves by any-angle ones
  PagedArray<Node> nodes_;
  PagedArray<double> reverse_seconds_;  // see Estimate; of a robot that may reverse
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  std::int64_t expansions_ = 0;
  bool has_begun_ = false;
  /// From here on, the vertices belong to a start that is replaced. They are not on the ways of other
  /// vertices.
  const int first_start_vertex_;
  bool start_known_ = false;  // their estimates
};

/// Expands until the cost to go from a vertex is known. Returns false if it has none, or if `stop` is met
/// first.
bool CostToGo::BackwardSearch::settle(int vertex, const StopCondition& stop) {
  begin(stop);
  const Node& n = node(vertex);
  StopStride stride(stop, kStopStride);
  while (n.state != State::closed) {
    if (open_.empty() || stride.met_at_step()) return false;
    expand_best();
  }
  return true;
}

/// No way from this vertex is known, and the search does not come to it.
void CostToGo::BackwardSearch::set_none(int vertex) {
  Node& n = node(vertex);
  n.state = State::closed;
  set(n, vertex, goal_, {kForever, 0.0, false});
}

/// Estimates the vertices of the start by their neighbours, again and again until nothing changes.
void CostToGo::BackwardSearch::estimate_start(const StopCondition& stop) {
  start_known_ = true;
  for (bool changed = true; changed && !stop.met();) {
    changed = false;
    for (int vertex = first_start_vertex_; vertex < vertices_.count(); ++vertex) {
      changed = estimate_start(vertex, stop) || changed;
    }
  }
}

/// Returns whether the cost to go is less than before.
bool CostToGo::BackwardSearch::estimate_start(int vertex, const StopCondition& stop) {
  Node& n = node(vertex);
  bool changed = false;
  const auto try_by = [&](int next) {
    const Estimate estimate = via(vertex, next);
    if (!(estimate.least() < least(n, vertex) - kSameTime)) return;
    set(n, vertex, next, estimate);
    changed = true;
  };
  vertices_.for_each_neighbour(vertex, [&](int neighbour) {
    if (!vertices_.allow(vertex, neighbour)) return;
    if (neighbour == goal_) return try_by(goal_);
    if (neighbour < first_start_vertex_ && !settle(neighbour, stop)) return;
    if (least(node(neighbour), neighbour) == kForever) return;
    try_by(neighbour);
    const int next = node(neighbour).next;
    if (vertices_.any_angle() && vertices_.in_sight(vertex, next)) try_by(next);
  });
  return changed;
}

void CostToGo::BackwardSearch::begin(const StopCondition& stop) {
  if (has_begun_) return;
  constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();
  if (from_start_ && !from_start_->reach_goal(kAnyNumber, stop)) return;
  has_begun_ = true;
  node(goal_).state = State::closed;
  relax_neighbours(goal_, goal_);
}

/// About the seconds that translations from the start to a vertex take, at least.
double CostToGo::BackwardSearch::seconds_from_start(int vertex) {
  if (!from_start_) return 0.0;
  const double straight = body_.cruise_time((vertices_.position(vertex) - start_position_).norm());
  return std::max(straight, shortening_ * from_start_->at_least(vertex));
}

/// The cost from `vertex` with a first translation straight to `next`, which is closed or the goal.
CostToGo::Estimate CostToGo::BackwardSearch::via(int vertex, int next) {
  const Displacement d = vertices_.between(vertex, next);
  Estimate estimate;
  estimate.heading = d.heading;
  estimate.seconds = translation_time(vertex, next, d.length) + body_.wait_before_move;
  if (body_.may_reverse) {
    add_onward(estimate, next, d.length);
    return estimate;
  }
  if (next != goal_) {
    const double then = heading(next);
    estimate.seconds += node(next).seconds + body_.rotation_time(estimate.heading, then);
    const bool continues_straight = angle_between(estimate.heading, then) <= kSameHeading;
    if (continues_straight) {  // both are one translation
      estimate.seconds -= body_.wait_before_move + body_.linear_inertia.loss(d.length, body_.linear_speed);
    }
  } else if (goal_heading_) {
    estimate.seconds += body_.rotation_time(estimate.heading, *goal_heading_);
  }
  return estimate;
}

/// Adds the cost from `next` on to the cost of the translation there, of this length, forwards and backwards.
void CostToGo::BackwardSearch::add_onward(Estimate& estimate, int next, double length) {
  const double back = opposite_heading(estimate.heading);
  const double translation = estimate.seconds;
  if (next == goal_) {
    estimate.reverse_seconds = translation;
    if (!goal_heading_) return;
    estimate.seconds += body_.rotation_time(estimate.heading, *goal_heading_);
    estimate.reverse_seconds += body_.rotation_time(back, *goal_heading_);
    return;
  }
  const Node& n = node(next);
  const Estimate onward{n.seconds, heading(next), false, reverse_seconds(next)};
  estimate.seconds = translation + onward.with_rotation(estimate.heading, body_);
  estimate.reverse_seconds = translation + onward.with_rotation(back, body_);
  const double once = body_.wait_before_move + body_.linear_inertia.loss(length, body_.linear_speed);
  if (once <= 0.0 || angle_between(estimate.heading, onward.heading) > kSameHeading) return;
  // A translation that goes on is one.
  estimate.seconds = std::min(estimate.seconds, translation + onward.seconds - once);
  estimate.reverse_seconds = std::min(estimate.reverse_seconds, translation + onward.reverse_seconds - once);
}

/// Makes the translation to `next` the first one from the vertex.
void CostToGo::BackwardSearch::set(Node& n, int vertex, int next, const Estimate& estimate) {
  n.seconds = estimate.seconds;
  n.next = next;
  if (body_.may_reverse) reverse_seconds_[static_cast<std::size_t>(vertex)] = estimate.reverse_seconds;
}

bool CostToGo::BackwardSearch::goal_in_sight(int vertex) {
  Node& n = node(vertex);
  if (!n.sight_known) {
    n.sight_known = true;
    n.in_sight = vertices_.in_sight(vertex, goal_);
  }
  return n.in_sight;
}

void CostToGo::BackwardSearch::relax(int vertex, int next) {
  Node& n = node(vertex);
  if (n.state == State::closed) return;
  const Estimate estimate = via(vertex, next);
  if (n.state == State::open && estimate.least() >= least(n, vertex)) return;
  n.state = State::open;
  set(n, vertex, next, estimate);
  open_.push({estimate.least() + seconds_from_start(vertex), estimate.least(), vertex});
}

void CostToGo::BackwardSearch::close(int vertex) {
  Node& n = node(vertex);
  n.state = State::closed;
  const bool free = n.next == goal_ ? goal_in_sight(vertex) : vertices_.in_sight(vertex, n.next);
  if (free) return;
  // Lazy Theta* (Nash, Koenig, Tovey, AAAI 2010): only now is it known that the shortcut is blocked.
  set(n, vertex, n.next, {kForever, 0.0, false});
  vertices_.for_each_neighbour(vertex, [&](int neighbour) {
    if (neighbour >= first_start_vertex_) return;
    if (neighbour != goal_ && node(neighbour).state != State::closed) return;
    if (!vertices_.allow(vertex, neighbour)) return;
    const Estimate estimate = via(vertex, neighbour);
    if (estimate.least() < least(n, vertex)) set(n, vertex, neighbour, estimate);
  });
}

void CostToGo::BackwardSearch::expand_best() {
  ++expansions_;
  const Open best = open_.top();
  open_.pop();
  Node& n = node(best.vertex);
  if (n.state == State::closed || best.seconds > least(n, best.vertex)) return;
  close(best.vertex);
  const int next = vertices_.any_angle() ? n.next : best.vertex;
  relax_neighbours(best.vertex, next);
}

/// Whether a speed zone makes the straight move take longer.
bool CostToGo::BackwardSearch::is_slowed(int vertex, int next) const {
  if (!vertices_.times().limit_speeds()) return false;
  const double length = vertices_.between(vertex, next).length;
  return translation_time(vertex, next, length) > body_.translation_time(length) + kSameTime;
}

/// Relaxes the neighbours of a vertex with a first translation straight to `next`. Past slow zones, the one
/// to the vertex may be faster.
void CostToGo::BackwardSearch::relax_neighbours(int vertex, int next) {
  vertices_.for_each_neighbour(vertex, [&](int neighbour) {
    if (!vertices_.allow(neighbour, vertex)) return;
    relax(neighbour, next);
    if (next != vertex && vertices_.times().limit_speeds()) relax(neighbour, vertex);
  });
}

CostToGo::CostToGo(const Vertices& vertices, std::size_t goal)
    : search_(std::make_unique<BackwardSearch>(vertices, goal)) {}
CostToGo::~CostToGo() = default;

void CostToGo::replace_start() { search_->replace_start(); }

std::vector<int> CostToGo::way(int vertex) { return search_->way(vertex); }

double CostToGo::metres(int vertex) { return search_->metres(vertex); }

CostToGo::Estimate CostToGo::from(int vertex, const StopCondition& stop) {
  return search_->from(vertex, stop);
}

std::optional<bool> CostToGo::reaches(int vertex, std::int64_t max_expansions, const StopCondition& stop) {
  return search_->reaches(vertex, max_expansions, stop);
}

std::int64_t CostToGo::expansions() const { return search_->expansions(); }

std::size_t CostToGo::bytes() const { return search_->bytes(); }

}  // namespace fleetplan::core
