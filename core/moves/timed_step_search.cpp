#include "core/moves/timed_step_search.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fleetplan::core {
namespace {

/// Moves between two checks of the stop condition, where queries are quick.
constexpr std::size_t kMovesBetweenPolls = 16;
/// The most nodes with the same places and intervals. Each is earlier than each other one in at least one
/// respect.
constexpr std::size_t kMaxAlike = 8;

}  // namespace

TimedStepSearch::TimedStepSearch(FleetReservations& reservations, const std::vector<std::size_t>& robots,
                                 const JointSteps& steps)
    : reservations_(reservations),
      robots_(robots),
      steps_(steps),
      moves_(reservations, robots, steps),
      margin_(reservations.instance().options().interval_margin),
      known_(2 * steps.size()),
      ends_(steps.size()),
      at_(steps.size(), 0),
      tuple_(2 * steps.size(), 0) {
  for (std::size_t k = 0; k < steps.size(); ++k) ends_[k].resize(steps.robot(k).places.size());
}

TimedStepSearch::Outcome TimedStepSearch::run(std::size_t max_nodes, const StopCondition& stop) {
  const IgnoredRobots ignored(reservations_, robots_);
  if (!std::exchange(has_begun_, true) && !begin()) return Outcome::none;
  StopStride stride(stop, reservations_.table().is_costly() ? 1 : kMovesBetweenPolls);
  while (!open_.empty()) {
    if (nodes_.size() >= max_nodes) return Outcome::cut_off;
    const std::uint32_t number = open_.top().second;
    if (is_end(number)) {
      end_ = number;
      return Outcome::found;
    }
    open_.pop();
    if (nodes_[number].is_closed) continue;
    if (!expand(number, stride)) return Outcome::cut_off;
  }
  return Outcome::none;
}

StepSequence TimedStepSearch::plan() const {
  StepSequence plan;
  for (std::uint32_t number = end_; number != kNone; number = nodes_[number].before) {
    const auto places = known_[nodes_[number].tuple];
    plan.configurations.emplace_back(places, places + static_cast<std::ptrdiff_t>(steps_.size()));
    if (nodes_[number].before != kNone) plan.departures.push_back(nodes_[number].departure);
  }
  std::reverse(plan.configurations.begin(), plan.configurations.end());
  std::reverse(plan.departures.begin(), plan.departures.end());
  return plan;
}

/// Returns false if a robot cannot stay where its plan begins.
bool TimedStepSearch::begin() {
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const auto rest = moves_.begin(k, nullptr);
    if (!rest) return false;
    rests_.push_back(*rest);
    tuple_[steps_.size() + k] = number_of(k, 0, rest->safe.end);
  }
  nodes_.emplace_back();
  first_of_tuple_.assign(1, 0);
  known_.add(tuple_);
  open_.emplace(0.0F, 0);
  return true;
}

bool TimedStepSearch::is_end(std::uint32_t number) const {
  const auto places = known_[nodes_[number].tuple];
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (!steps_.robot(k).is_end(places[static_cast<std::ptrdiff_t>(k)])) return false;
    if (rest(number, k).safe.end != kForever) return false;
  }
  return true;
}

/// Returns false if the stop condition is met before all moves are known: then the node is expanded again.
bool TimedStepSearch::expand(std::uint32_t number, StopStride& stride) {
  std::copy_n(known_[nodes_[number].tuple], steps_.size(), at_.begin());
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const StepPlaces& places = steps_.robot(k);
    for (const StepPlaces::Step& step : places.steps_from(at_[k])) {
      if (stride.met_at_step()) {
        open_.emplace(0.0F, number);
        return false;
      }
      if (places.has_way(step.to) && !steps_.touches_any(k, step, at_)) move(number, k, step);
    }
  }
  nodes_[number].is_closed = true;
  return true;
}

/// Adds the moves of a step, one for each safe interval of the place that it leads to.
void TimedStepSearch::move(std::uint32_t number, std::size_t k, const StepPlaces::Step& step) {
  const Node from = nodes_[number];
  const bool again = from.moved == k;
  const double others_ended = again ? from.others_ended : from.free_from;
  double others_leave = kForever;
  for (std::size_t other = 0; other < steps_.size(); ++other) {
    if (other != k) others_leave = std::min(others_leave, rest(number, other).safe.end);
  }
  Node node;
  node.before = number;
  node.moved = static_cast<std::uint32_t>(k);
  node.way = from.way + step.length;
  node.others_ended = others_ended;
  const std::uint32_t stage = steps_.robot(k).at(at_[k]).stage;
  const auto visit = [&](const TimedStep& timed) {
    StepRest after = timed.rest;
    if (!moves_.serve(k, stage, steps_.robot(k).at(step.to).stage, after, nullptr)) return false;
    node.departure = timed.time.begin;
    node.free_from = timed.time.end + margin_;
    add(node, k, step.to, after);
    return false;
  };
  const StepRest before = rest(number, k);  // nodes are added
  moves_.for_each_move(k, at_[k], step.to, before, 0.0, others_ended, others_leave, visit);
}

void TimedStepSearch::add(const Node& node, std::size_t k, int place, const StepRest& rest) {
  std::copy_n(known_[nodes_[node.before].tuple], tuple_.size(), tuple_.begin());
  tuple_[k] = place;
  tuple_[steps_.size() + k] = number_of(k, place, rest.safe.end);
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  for (std::size_t other = 0; other < steps_.size(); ++other) {
    rests_.push_back(other == k ? rest : StepRest(this->rest(node.before, other)));
  }
  const std::uint32_t tuple = known_.add(tuple_);
  if (tuple == first_of_tuple_.size()) first_of_tuple_.push_back(kNone);
  if (!is_early(number, tuple)) {
    nodes_.pop_back();
    rests_.resize(rests_.size() - steps_.size());
    return;
  }
  nodes_[number].tuple = tuple;
  nodes_[number].other = std::exchange(first_of_tuple_[tuple], number);
  float left = 0.0F;
  for (std::size_t robot = 0; robot < steps_.size(); ++robot) {
    left += steps_.robot(robot).at(tuple_[robot]).to_go;
  }
  open_.emplace(node.way + SingleMoveSearch::kGreed * left, number);
}

/// Whether no node with the same places and intervals is as early as this node. Forgets nodes that this node
/// makes useless.
bool TimedStepSearch::is_early(std::uint32_t number, std::uint32_t tuple) {
  std::size_t alike = 0;
  std::uint32_t* link = &first_of_tuple_[tuple];
  // Bounded: few nodes are alike.
  while (*link != kNone) {
    Node& other = nodes_[*link];
    if (is_no_later(*link, number)) return false;
    if (is_no_later(number, *link)) {
      other.is_closed = true;
      *link = other.other;
    } else {
      ++alike;
      link = &other.other;
    }
  }
  return alike < kMaxAlike;
}

/// Whether everything that can follow on one node can follow on the other node at the same times. Both have
/// the same places and intervals.
bool TimedStepSearch::is_no_later(std::uint32_t a, std::uint32_t b) const {
  const double others_ended =
      nodes_[a].moved == nodes_[b].moved ? nodes_[a].others_ended : nodes_[a].free_from;
  if (nodes_[a].free_from > nodes_[b].free_from || others_ended > nodes_[b].others_ended) return false;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (!is_ready(k, tuple_[k], rest(a, k), rest(b, k))) return false;
  }
  return true;
}

/// Whether a robot that rests like `a` can do whatever it can do if it rests like `b`.
bool TimedStepSearch::is_ready(std::size_t k, int place, const StepRest& a, const StepRest& b) const {
  if (a.t_ready > b.t_ready) return false;
  const bool is_same = a.t_ready == b.t_ready && a.heading == b.heading && a.is_served == b.is_served;
  if (is_same) return true;
  const StepPlaces::Place& at = steps_.robot(k).at(place);
  const MoveTimes times = moves_.times(k, at.stage);
  return a.t_ready + times.rotation_time(at.position, a.heading, b.heading) + times.body().wait_before_move <=
         b.t_ready;
}

/// The number of the safe interval of the place that ends then.
int TimedStepSearch::number_of(std::size_t k, int place, double end) {
  std::vector<double>& ends = ends_[k][static_cast<std::size_t>(place)];
  const auto number = std::find(ends.begin(), ends.end(), end) - ends.begin();
  if (number == std::ssize(ends)) ends.push_back(end);
  return static_cast<int>(number);
}

}  // namespace fleetplan::core
