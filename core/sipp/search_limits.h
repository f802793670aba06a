#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/geometry/segment.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// Asked by a long search whether it can end, because there is no path.
class NoPathTest {
 public:
  NoPathTest() = default;
  virtual ~NoPathTest() = default;
  NoPathTest(const NoPathTest&) = delete;
  NoPathTest& operator=(const NoPathTest&) = delete;

  virtual bool no_path(std::int64_t expansions) = 0;
};

/// The parameters of the search for one robot: limits of cost and effort, and the accepted suboptimality.
struct SearchLimits {
  double bound = kForever;        // seconds; only trajectories that cost less are accepted
  double heuristic_weight = 1.2;  // >= 1; weight of h in f = g + weight * h (weighted A*; Pohl, 1970)
  double suboptimality = 0.01;    // accepts a path to the goal that costs at most (1 + this) * the smallest f
  double suboptimality_growth = 1e-4;  // added to `suboptimality` with every expansion
  /// An arrival also counts as dominated, whatever its heading, if it is later than another one in the same
  /// safe interval, or earlier by less than the time to translate by this many lattice spacings. 0: exact
  /// dominance.
  double dominance_slack = 0.5;
  /// Seconds: a path may also end from this time on wherever the robot may rest for good, at the estimated
  /// cost of its static way from there. kForever: only at the goal.
  double horizon = kForever;
  double start_delay = 0.0;  // seconds, >= 0; the robot stays where it begins at least this long
  /// Search again with exact dominance if the quick search finds nothing. The quick search applies
  /// `dominance_slack`, and keeps only one label per safe interval while f is below the time from which the
  /// goal is free.
  bool thorough = true;
  /// Of both searches together; a search that needs more ends as not complete.
  std::int64_t max_expansions = std::numeric_limits<std::int64_t>::max();
  /// May be null. Asked after kFirstTest expansions and whenever their number has doubled.
  NoPathTest* no_path_test = nullptr;
  static constexpr std::int64_t kFirstTest = 512;
};

/// The result of a search for one robot.
struct SearchResult {
  std::optional<Trajectory> trajectory;
  /// Without a trajectory: false if the stop condition or max_expansions ended the search. True otherwise;
  /// with `thorough`, then no trajectory costs less than the bound (except those that dominance loses, see
  /// docs/method.md).
  bool complete = true;
  std::int64_t expansions = 0;
};

}  // namespace fleetplan::core
