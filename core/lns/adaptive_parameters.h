#pragma once

#include <cstddef>
#include <cstdint>

#include "core/lns/adaptive_choice.h"
#include "core/lns/neighbourhood.h"
#include "core/runtime/random.h"
#include "core/sipp/aa_sipp.h"

namespace fleetplan::core {

/// The parameters of one iteration of large neighbourhood search: which robots, how many, and the effort.
/// Each is chosen by its recent gain per effort (see AdaptiveChoice).
class AdaptiveParameters {
 public:
  /// Positions in the lists of possible values.
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
  /// `gain` in seconds, >= 0.
  void learn(const Choice& choice, double gain, std::int64_t searches, std::int64_t expansions);

 private:
  AdaptiveChoice kinds_;
  AdaptiveChoice sizes_;
  AdaptiveChoice limits_;
};

}  // namespace fleetplan::core
