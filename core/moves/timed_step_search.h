#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/moves/joint_steps.h"
#include "core/moves/known_tuples.h"
#include "core/moves/single_move_search.h"
#include "core/moves/step_moves.h"
#include "core/moves/step_times.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans robots in steps among other moving things: obstacles, committed motion, robots that keep their
/// plans. In each step, one robot moves while all others rest.
///
/// This is safe-interval path planning (Phillips and Likhachev, ICRA 2011) of all robots as if they were one.
/// A node has, for each robot, a place and a safe interval there, and is reached as early as possible. A
/// best-first search, in which the way that is left counts more than the way so far.
class TimedStepSearch {
 public:
  /// All arguments must outlive this object. `steps` belong to `robots`, in their order.
  TimedStepSearch(FleetReservations& reservations, const std::vector<std::size_t>& robots,
                  const JointSteps& steps);

  using Outcome = SingleMoveSearch::Outcome;
  /// Continues until so many nodes are known. The reservations of other robots must be the same each time.
  Outcome run(std::size_t max_nodes, const StopCondition& stop);

  /// Once the plan is found: the steps from the starts to the goals.
  StepSequence plan() const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  /// The places of all robots before the next one moves.
  struct Node {
    std::uint32_t before = kNone;
    std::uint32_t tuple = 0;      // number of the places and safe intervals
    std::uint32_t other = kNone;  // with the same ones
    std::uint32_t moved = kNone;  // the robot that has moved last
    float way = 0.0F;             // metres, of all robots from the starts on
    bool is_closed = false;
    double departure = 0.0;     // seconds: when it moved
    double free_from = 0.0;     // seconds: then its last move has ended
    double others_ended = 0.0;  // seconds: then the others' last move has ended
  };
  using Open = std::pair<float, std::uint32_t>;

  bool begin();
  bool is_end(std::uint32_t number) const;
  bool expand(std::uint32_t number, StopStride& stride);
  void move(std::uint32_t number, std::size_t k, const StepPlaces::Step& step);
  void add(const Node& node, std::size_t k, int place, const StepRest& rest);
  bool is_early(std::uint32_t number, std::uint32_t tuple);
  bool is_no_later(std::uint32_t a, std::uint32_t b) const;
  bool is_ready(std::size_t k, int place, const StepRest& a, const StepRest& b) const;
  int number_of(std::size_t k, int place, double end);
  const StepRest& rest(std::uint32_t number, std::size_t k) const {
    return rests_[number * steps_.size() + k];
  }

  FleetReservations& reservations_;
  const std::vector<std::size_t>& robots_;
  const JointSteps& steps_;
  const StepMoves moves_;
  const double margin_;  // seconds
  KnownTuples known_;    // the places of all robots, then the numbers of their intervals
  std::vector<std::uint32_t> first_of_tuple_;  // nodes, by tuple
  std::vector<Node> nodes_;
  std::vector<StepRest> rests_;                         // of all robots, node by node
  std::vector<std::vector<std::vector<double>>> ends_;  // of safe intervals, by robot and place
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  Configuration at_;        // of the node that is expanded
  std::vector<int> tuple_;  // of a node that is added
  std::uint32_t end_ = kNone;
  bool has_begun_ = false;
};

}  // namespace fleetplan::core
