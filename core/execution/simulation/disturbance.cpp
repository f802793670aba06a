#include "core/execution/simulation/disturbance.h"

#include <cmath>
#include <numbers>

#include "core/geometry/elementary_functions.h"
#include "core/runtime/random.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kDrawsBetweenPolls = 1024;
constexpr double kSecondsPerHour = 3600.0;

/// The seed of one run: a bijection of the 64 bits after which no two seeds or runs are similar. Steele, Lea
/// and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

class Draw {
 public:
  Draw(const Disturbance& disturbance, std::uint64_t seed, std::uint64_t run, const StopCondition& stop)
      : disturbance_(disturbance), random_(mixed(mixed(seed) + run)), stride_(stop, kDrawsBetweenPolls) {}

  DisturbedActions actions(const std::vector<Action>& planned) {
    DisturbedActions drawn;
    drawn.actions.reserve(planned.size());
    for (const Action& action : planned) {
      DisturbedActions::Of& of = drawn.actions.emplace_back();
      of.start_delay = uniform(disturbance_.start_delay);
      of.halts.begin = drawn.all_halts.size();
      of.offsets.begin = drawn.all_offsets.size();
      if (action.type != Action::Type::wait) {
        const bool turns = action.type == Action::Type::rotate;
        of.factor = uniform(turns ? disturbance_.turn : disturbance_.speed);
        of.moving = (action.t_end - action.t_start) / of.factor;
        add_halts(of.moving, drawn.all_halts);
        if (!turns) add_offsets((action.to.position - action.from.position).norm(), drawn.all_offsets);
      }
      of.halts.end = drawn.all_halts.size();
      of.offsets.end = drawn.all_offsets.size();
      if (stopped()) break;
    }
    return drawn;
  }

  bool stopped() const { return stride_.met(); }

 private:
  /// Draws a number from [0, 1); looks at the stop condition once in many draws.
  double unit() {
    stride_.met_at_step();
    return random_.unit();
  }

  double uniform(const UniformRange& range) {
    return range.min < range.max ? range.min + unit() * (range.max - range.min) : range.min;
  }

  double exponential(double mean) { return -mean * natural_logarithm(1.0 - unit()); }

  /// Draws a number from the standard normal distribution, by the method of Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2.0 * natural_logarithm(1.0 - unit()));
    return radius * cosine(2.0 * std::numbers::pi * unit());
  }

  void add_halts(double moving, std::vector<DisturbedActions::Halt>& halts) {
    const Disturbance::Stops& stops = disturbance_.stops;
    if (stops.rate_per_hour <= 0.0 || stops.mean_s <= 0.0) return;
    const double mean_gap = kSecondsPerHour / stops.rate_per_hour;
    for (double at = exponential(mean_gap); at < moving && !stopped(); at += exponential(mean_gap)) {
      halts.push_back({at, exponential(stops.mean_s)});
    }
  }

  void add_offsets(double length, std::vector<double>& offsets) {
    if (!disturbance_.leaves_paths()) return;
    const double knots = std::round(length / disturbance_.cross_track.correlation_length);
    for (double knot = 0.0; knot < knots && !stopped(); knot += 1.0) {
      offsets.push_back(disturbance_.cross_track.sigma * normal());
    }
  }

  const Disturbance& disturbance_;
  Random random_;
  StopStride stride_;
};

}  // namespace

std::optional<std::vector<DisturbedActions>> draw_disturbances(const std::vector<RobotPlan>& plans,
                                                               const Disturbance& disturbance,
                                                               std::uint64_t seed, std::uint64_t run,
                                                               const StopCondition& stop) {
  Draw draw(disturbance, seed, run, stop);
  std::vector<DisturbedActions> drawn;
  drawn.reserve(plans.size());
  for (const RobotPlan& plan : plans) {
    drawn.push_back(draw.actions(plan.actions));
    if (draw.stopped()) return std::nullopt;
  }
  return drawn;
}

std::optional<std::vector<ActionPhase>> moving_phases(const DisturbedActions& disturbed, std::size_t action,
                                                      const StopCondition& stop) {
  constexpr std::size_t kHaltsBetweenPolls = 512;
  const double moving = disturbed.actions[action].moving;
  std::vector<ActionPhase> phases;
  double moved = 0.0;
  double fraction = 0.0;
  StopStride stride(stop, kHaltsBetweenPolls);
  for (const DisturbedActions::Halt& halt : disturbed.halts(action)) {
    if (stride.met_at_step()) return std::nullopt;
    fraction = halt.after / moving;
    phases.push_back({halt.after - moved, fraction});
    phases.push_back({halt.seconds, fraction});
    moved = halt.after;
  }
  phases.push_back({moving - moved, 1.0});
  return phases;
}

namespace {

/// The factors on the speeds of the actions of a drive.
std::vector<double> factors(Actions actions, std::size_t first, const DisturbedActions& disturbed) {
  std::vector<double> all;
  const std::size_t end = end_of_drive(actions, first);
  for (std::size_t k = first; k < end; ++k) all.push_back(disturbed.actions[k].factor);
  return all;
}

}  // namespace

DisturbedDrive::DisturbedDrive(Actions actions, std::size_t first, const DisturbedActions& disturbed,
                               double t, double start_speed)
    : drive(actions, first, factors(actions, first, disturbed), t, start_speed) {
  // Bounded: the halts that were drawn.
  for (std::size_t k = first; k < drive.end(); ++k) {
    const double moving = disturbed.actions[k].moving;
    for (const DisturbedActions::Halt& at : disturbed.halts(k)) {
      halts.push_back({drive.place_of(k, share_covered(actions[k], at.after / moving)), at.seconds});
    }
  }
}

}  // namespace fleetplan::core
