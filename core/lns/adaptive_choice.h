#pragma once

// What an iteration of large neighbourhood search chooses by recent success.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lns/neighbourhood.h"
#include "core/runtime/random.h"
#include "core/sipp/aa_sipp.h"

namespace fleetplan::core {

/// Chooses among a few alternatives by their recent gain per effort (adaptive large neighbourhood search;
/// Ropke and Pisinger, 2006). Every alternative keeps a positive probability.
class AdaptiveChoice {
 public:
  /// Chooses among `count` >= 1 alternatives, all equal at first.
  explicit AdaptiveChoice(std::size_t count) : records_(count) {}

  std::size_t choose(Random& random) const;

  /// Records one try of the alternative: its gain (>= 0) and its effort (> 0), in any units.
  void learn(std::size_t alternative, double gain, double effort);

 private:
  struct Record {  // moving averages over tries
    double gain = 0.0;
    double effort = 0.0;  // 0: not tried yet
  };

  /// The gain per effort of an alternative.
  double rate(const Record& record) const;
  std::vector<double> weights() const;

  std::vector<Record> records_;
};

/// Chooses the robot whose cost an iteration tries to reduce: with a probability that grows with its delay
/// (cost minus lower bound) and falls with its recent failures.
class DelayedChoice {
 public:
  /// Chooses among robots 0 to count - 1.
  explicit DelayedChoice(std::size_t count) : failures_(count, 0.0) {}

  /// Returns one of `robots` (not empty); delays[k] >= 0 is the delay of robots[k] in seconds.
  std::size_t choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                     Random& random) const;

  /// Records whether an iteration made the robot cheaper.
  void learn(std::size_t robot, bool gained);

 private:
  std::vector<double> failures_;  // by robot; failures before a gain count less
};

/// The parameters of one iteration of large neighbourhood search: which robots, how many, and the effort.
/// Each is chosen by its recent gain per effort (see AdaptiveChoice).
class AdaptiveParameters {
 public:
  /// The choice of each parameter, as positions in the lists of possible values.
  struct Choice {
    std::size_t kind = 0;
    std::size_t size = 0;
    std::size_t limits = 0;

    Neighbourhood neighbourhood() const { return static_cast<Neighbourhood>(kind); }
    std::size_t robots() const;
    const SearchLimits& search_limits() const;
  };

  AdaptiveParameters();

  Choice choose(Random& random) const;
  /// Records the result of an iteration: `gain` in seconds, >= 0, and the searches and expansions that it
  /// took.
  void learn(const Choice& choice, double gain, std::int64_t searches, std::int64_t expansions);

 private:
  AdaptiveChoice kinds_;
  AdaptiveChoice sizes_;
  AdaptiveChoice limits_;
};

}  // namespace fleetplan::core
