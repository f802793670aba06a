#include "core/moves/pushing_search.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

/// Where pushing helps, it needs few configurations; others are left to other searches.
constexpr ConfigurationLimits kPlaceLimits{
    .max_nodes = 5'000, .max_places = 1'000'000, .max_constraints = 20'000};
/// How often the search is tried, each time with other random numbers.
constexpr int kMaxPlaceTries = 2;

/// A fleet on its places, see ConfigurationSearch. Makes configurations with Priority Inheritance with
/// Backtracking.
class FleetOnPlaces {
 public:
  FleetOnPlaces(const JointSteps& steps, Random& random, const StopCondition& stop)
      : steps_(steps), random_(random), stop_(stop), is_asked_(steps.size(), false) {}

  Configuration starts() const { return Configuration(steps_.size(), 0); }
  bool is_end(const Configuration& at) const { return steps_.is_end(at); }
  bool is_home(std::size_t robot, int place) const { return steps_.robot(robot).is_end(place); }
  bool comes_before(std::size_t a, std::size_t b) const {
    const float far_a = steps_.robot(a).places.front().to_go;
    const float far_b = steps_.robot(b).places.front().to_go;
    return far_a != far_b ? far_a > far_b : a < b;
  }

  template <class Visitor>
  void for_each_step(std::size_t robot, int place, const Visitor& visit) const {
    for (const StepPlaces::Step& step : steps_.robot(robot).steps_from(place)) visit(step.to);
  }

  std::optional<Configuration> next(const Configuration& from, const std::vector<std::size_t>& order,
                                    const std::vector<StepConstraint>& constraints, std::size_t constraint,
                                    std::size_t /*depth*/) {
    from_ = &from;
    to_.assign(from.size(), StepConstraint::kNone);
    if (!bind(constraints, constraint)) return std::nullopt;
    for (const std::size_t robot : order) {
      if (stop_.met() || (!is_decided(robot) && !move(robot))) return std::nullopt;
    }
    if (!steps_.order_of_step(from, to_)) return std::nullopt;
    return to_;
  }

 private:
  using Move = JointSteps::Move;
  using Order = JointSteps::Order;

  bool is_decided(std::size_t robot) const { return to_[robot] != StepConstraint::kNone; }
  Move move_of(std::size_t robot) const { return {robot, (*from_)[robot], to_[robot]}; }

  bool bind(const std::vector<StepConstraint>& constraints, std::size_t last) {
    for (std::size_t k = last; constraints[k].place != StepConstraint::kNone; k = constraints[k].before) {
      const Move move{constraints[k].robot, (*from_)[constraints[k].robot], constraints[k].place};
      if (!agrees_with_decided(move)) return false;
      to_[move.robot] = move.to;
    }
    return true;
  }

  bool agrees_with_decided(const Move& move) const {
    for (std::size_t other = 0; other < to_.size(); ++other) {
      if (other == move.robot) continue;
      if (is_decided(other) && steps_.order_of(move, move_of(other)) == Order::none) return false;
      // It has asked for room, so it moves later.
      if (is_asked_[other] && !move.rests() && steps_.touches(move, other, (*from_)[other])) return false;
    }
    return true;
  }

  /// The places that a robot may go to, the best first.
  std::vector<int> choices_of(std::size_t robot) {
    const int from = (*from_)[robot];
    std::vector<std::pair<std::pair<float, std::size_t>, int>> keys;
    const StepPlaces& places = steps_.robot(robot);
    const auto add = [&](int place) {
      keys.push_back({{places.at(place).to_go, random_.below(1U << 16)}, place});
    };
    for_each_step(robot, from, add);
    add(from);
    std::sort(keys.begin(), keys.end());
    std::vector<int> choices;
    choices.reserve(keys.size());
    for (const auto& key : keys) choices.push_back(key.second);
    return choices;
  }

  /// Returns false if the robot cannot stay, and has nowhere to go. Depth: at most one for each robot.
  bool move(std::size_t robot) {
    const int from = (*from_)[robot];
    is_asked_[robot] = true;
    for (const int place : choices_of(robot)) {
      const Move move{robot, from, place};
      if (!agrees_with_decided(move)) continue;
      to_[robot] = place;
      if (push_away(move)) {
        is_asked_[robot] = false;
        return true;
      }
      to_[robot] = StepConstraint::kNone;
    }
    is_asked_[robot] = false;
    to_[robot] = from;
    return agrees_with_decided(move_of(robot));
  }

  /// Moves robots away that are in the way of a move.
  bool push_away(const Move& move) {
    if (move.rests()) return true;
    for (std::size_t other = 0; other < to_.size(); ++other) {
      if (other == move.robot || is_decided(other)) continue;
      if (steps_.touches(move, other, (*from_)[other]) && !this->move(other)) return false;
    }
    return true;
  }

  const JointSteps& steps_;
  Random& random_;
  const StopCondition& stop_;
  const Configuration* from_ = nullptr;
  Configuration to_;
  std::vector<bool> is_asked_;  // by robot: whether it waits for another robot to go away
};

}  // namespace

std::optional<std::vector<Configuration>> plan_by_pushing(const JointSteps& steps, Random& random,
                                                          const StopCondition& stop) {
  for (int k = 0; k < kMaxPlaceTries && !stop.met(); ++k) {
    FleetOnPlaces fleet(steps, random, stop);
    ConfigurationSearch search(fleet, kPlaceLimits, random, stop);
    auto plan = search.run();
    if (plan || search.has_no_way()) return plan;
  }
  return std::nullopt;
}

}  // namespace fleetplan::core
