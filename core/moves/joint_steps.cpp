#include "core/moves/joint_steps.h"

#include <algorithm>
#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Pairs of a step and a place of which it is known whether they touch: 4 MB.
constexpr std::size_t kMaxKnown = 4'000'000;

}  // namespace

JointSteps::JointSteps(const std::vector<StepPlaces>& robots) : robots_(robots) {
  start_distance_.assign(size(), std::vector<float>(size(), static_cast<float>(kForever)));
  // Bounded: few robots.
  for (std::size_t a = 0; a < size(); ++a) {
    for (std::size_t b = 0; b < size(); ++b) {
      if (a == b) continue;
      const StepPlaces::Place& mine = robots_[a].places.front();
      const StepPlaces::Place& theirs = robots_[b].places.front();
      const double distance = (mine.position - theirs.position).norm();
      if (distance < mine.radius + theirs.radius) start_distance_[a][b] = static_cast<float>(distance);
    }
  }
  first_step_.push_back(0);
  first_place_.push_back(0);
  for (const StepPlaces& robot : robots_) {
    first_step_.push_back(first_step_.back() + robot.steps.size());
    first_place_.push_back(first_place_.back() + robot.places.size());
  }
  if (first_step_.back() <= kMaxKnown / first_place_.back()) {
    known_.assign(first_step_.back() * first_place_.back(), Known::nothing);
  }
}

bool JointSteps::is_end(const Configuration& at) const {
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (!robots_[k].is_end(at[k])) return false;
  }
  return true;
}

bool JointSteps::touches_any(std::size_t robot, const StepPlaces::Step& step, const Configuration& at) const {
  const Move move{robot, at[robot], step.to};
  const auto number = static_cast<std::size_t>(&step - robots_[robot].steps.data());
  Known* known = known_.empty() ? nullptr : &known_[(first_step_[robot] + number) * first_place_.back()];
  for (std::size_t other = 0; other < at.size(); ++other) {
    if (other == robot) continue;
    if (known == nullptr) {
      if (touches(move, other, at[other])) return true;
      continue;
    }
    Known& pair = known[first_place_[other] + static_cast<std::size_t>(at[other])];
    if (pair == Known::nothing) pair = touches(move, other, at[other]) ? Known::touching : Known::clear;
    if (pair == Known::touching) return true;
  }
  return false;
}

double JointSteps::reach(const Move& move, std::size_t other, int place) const {
  const StepPlaces& mine = robots_[move.robot];
  const StepPlaces::Place& theirs = robots_[other].at(place);
  const double radius = std::max(mine.at(move.from).radius, mine.at(move.to).radius);
  const double full = radius + theirs.radius - kSearchSlack;
  if (move.from != 0 || place != 0) return full;
  return std::min<double>(full, start_distance_[move.robot][other] * (1.0 - 1e-6));
}

bool JointSteps::touches(const Move& move, std::size_t other, int place) const {
  const StepPlaces& mine = robots_[move.robot];
  const Segment way{mine.at(move.from).position, mine.at(move.to).position};
  return distance_to_segment(robots_[other].at(place).position, way) < reach(move, other, place);
}

JointSteps::Order JointSteps::order_of(const Move& first, const Move& second) const {
  bool is_first = false;
  bool is_second = false;
  if (!first.rests()) {
    is_second = touches(first, second.robot, second.from);
    is_first = touches(first, second.robot, second.to);
  }
  if (!second.rests()) {
    is_first = is_first || touches(second, first.robot, first.from);
    is_second = is_second || touches(second, first.robot, first.to);
  }
  if (is_first && is_second) return Order::none;
  if (is_first) return second.rests() || first.rests() ? Order::none : Order::first;
  if (is_second) return second.rests() || first.rests() ? Order::none : Order::second;
  return Order::any;
}

std::optional<std::vector<std::size_t>> JointSteps::order_of_step(const Configuration& from,
                                                                  const Configuration& to) const {
  std::vector<std::vector<std::size_t>> after(from.size());
  std::vector<std::size_t> before_count(from.size(), 0);
  // Bounded: few robots.
  for (std::size_t a = 0; a < from.size(); ++a) {
    for (std::size_t b = a + 1; b < from.size(); ++b) {
      const Order order = order_of({a, from[a], to[a]}, {b, from[b], to[b]});
      if (order == Order::none) return std::nullopt;
      if (order == Order::any) continue;
      const auto [early, late] = order == Order::first ? std::pair(a, b) : std::pair(b, a);
      after[early].push_back(late);
      ++before_count[late];
    }
  }
  std::vector<std::size_t> sequence;
  std::size_t moving = 0;
  for (std::size_t robot = 0; robot < from.size(); ++robot) {
    if (from[robot] == to[robot]) continue;
    ++moving;
    if (before_count[robot] == 0) sequence.push_back(robot);
  }
  // Bounded: each robot comes once.
  for (std::size_t k = 0; k < sequence.size(); ++k) {
    for (const std::size_t late : after[sequence[k]]) {
      if (--before_count[late] == 0) sequence.push_back(late);
    }
  }
  if (sequence.size() != moving) return std::nullopt;
  return sequence;
}

}  // namespace fleetplan::core
