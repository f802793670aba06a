#pragma once

// Whether the share of bad runs is at most an aim. A sequential test judges the runs so far, at fixed numbers
// of runs. It compares exact binomial tails.

#include <cstddef>
#include <cstdint>

namespace fleetplan::core {

/// P(X <= count) of a binomial X of `runs` trials, each with probability `share` in (0, 1).
double at_most(std::size_t count, std::size_t runs, double share);
/// P(X >= count).
double at_least(std::size_t count, std::size_t runs, double share);

/// A closed interval of shares.
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};

/// The interval of Clopper and Pearson for the share, after `count` of `runs` > 0 trials. It covers the true
/// share with a probability of at least `confidence`, in (0, 1).
ShareInterval clopper_pearson(std::size_t count, std::size_t runs, double confidence);

/// What the share of bad runs shall be.
struct ShareAim {
  double share = 0.01;       // at most so much, in (0, 1)
  double confidence = 0.95;  // in (0, 1): the chance that no verdict is wrong
};

/// The test of several candidates, each with its own runs. All verdicts together are right with the
/// confidence of the aim, by the union bound over the candidates and their looks:
///
///   met:     P(X <= bad) <= e if the share were that of the aim
///   not met: P(X >= bad) <= e
///   e = (1 - confidence) / (2 candidates looks)
class ShareTest {
 public:
  enum class Verdict : std::uint8_t { open, met, not_met };

  /// The first look; each further one is after twice as many runs, and the last one after all.
  static constexpr std::size_t kFirstLook = 50;

  /// At most `runs` >= kFirstLook runs for each of `candidates` > 0.
  ShareTest(const ShareAim& aim, std::size_t candidates, std::size_t runs);

  /// The runs of the next look after so many, less than all.
  std::size_t next_look(std::size_t runs) const;
  /// What a look says after so many runs, of which some were bad.
  Verdict look(std::size_t bad, std::size_t runs) const;
  /// The least runs that can meet the aim: so many without a bad one.
  std::size_t least_runs() const;

 private:
  double aim_;
  std::size_t runs_;
  double error_;  // e
};

}  // namespace fleetplan::core
