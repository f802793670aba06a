#include "core/execution/staircase.h"

#include <algorithm>
#include <limits>

namespace fleetplan::core {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class StaircaseSearch {
 public:
  StaircaseSearch(const std::vector<PassedRegion>& regions, const Pace& first, const Pace& second,
                  double slack)
      : regions_(regions), first_(first), second_(second), slack_(slack) {}

  std::optional<Staircase> run(const StopCondition& stop) {
    for (double gate = gate_after(-1.0); gate < kNever;) {
      if (stop.met()) return std::nullopt;
      const double t = second_.time_at(gate);
      double reached = first_.progress_at(t - slack_);
      double next = gate_after(reached);
      const double step = second_.progress_at(t + 0.5 * slack_);
      if (next < step) {
        reached = first_.progress_at(t - 0.5 * slack_);
        next = gate_after(reached);
      }
      const bool is_tight = next < step;
      if (is_tight) note_tightness(step);
      was_tight_ = is_tight;
      next = std::max(next, step);
      const double until = std::min(reached, needed_until(next));
      if (until > 0.0) found_.steps.push_back({gate, until});
      gate = next > gate ? next : kNever;
    }
    return std::move(found_);
  }

 private:
  /// The least v at which u must be beyond this.
  double gate_after(double first) const {
    double least = kNever;
    for (const PassedRegion& region : regions_) least = std::min(least, region.second_after(first));
    return least;
  }

  /// What u must reach before v may be at most this.
  double needed_until(double second) const {
    double most = 0.0;
    for (const PassedRegion& region : regions_) most = std::max(most, region.first_before(second));
    return most;
  }

  void note_tightness(double second) {
    const double t = second_.time_at(second);
    const double slack = std::max(0.0, t - first_.time_at(needed_until(second)));
    if (!was_tight_) {
      found_.tight.push_back({t, slack});
    } else if (slack < found_.tight.back().slack) {
      found_.tight.back() = {t, slack};
    }
  }

  const std::vector<PassedRegion>& regions_;
  const Pace& first_;
  const Pace& second_;
  double slack_;
  bool was_tight_ = false;
  Staircase found_;
};

}  // namespace

double PassedRegion::second_after(double first) const {
  const double from = first_length > 0.0 ? (first - first_begin) / first_length : 0.0;
  const auto range = shares.second_beyond(from);
  return range ? second_begin + range->least * second_length : kNever;
}

double PassedRegion::first_before(double second) const {
  const double to = second_length > 0.0 ? (second - second_begin) / second_length : 1.0;
  const auto range = shares.first_up_to(to);
  return range ? first_begin + range->most * first_length : -kNever;
}

std::optional<Staircase> staircase_of(const std::vector<PassedRegion>& regions, const Pace& first,
                                      const Pace& second, double slack, const StopCondition& stop) {
  return StaircaseSearch(regions, first, second, slack).run(stop);
}

}  // namespace fleetplan::core
