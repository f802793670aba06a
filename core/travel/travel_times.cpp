#include "core/travel/travel_times.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <variant>

#include "core/compile/instance.h"
#include "core/geometry/segment.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/memory_account.h"
#include "core/runtime/shared_turn.h"
#include "core/sipp/aa_sipp.h"
#include "core/sipp/search_space.h"

namespace fleetplan::core {

namespace {

/// The limits of a search that finds the cheapest path that any of the planner's searches can be expected to
/// find.
constexpr SearchSettings kExact{
    .heuristic_weight = 1.0, .suboptimality = 0.0, .suboptimality_growth = 0.0, .dominance_slack = 0.0};

double metres_of(const Trajectory& trajectory) {
  double metres = 0.0;
  for (const TimedMove& move : trajectory.moves) metres += move.path.length();
  return metres;
}

/// What one thread needs for the ways of a column.
class Travels {
 public:
  /// `fixed`: the reservations of another instance of the same problem, or null.
  Travels(const Problem& problem, const PlanOptions& options, std::shared_ptr<const FixedReservations> fixed,
          const StopCondition& stop)
      : instance_(fixed == nullptr ? Instance(problem, options, stop)
                                   : Instance(problem, options, std::move(fixed), stop)),
        nobody_(problem.grid().width(), problem.grid().height(), problem.grid().width(),
                std::vector<LargestDisk>(problem.robots().size(), instance_.views(0).largest_disk())),
        search_(nobody_) {}

  const Instance& instance() const { return instance_; }

  /// Returns the ways of a column; they must not be used if `stop` is met.
  std::vector<std::optional<Travel>> column(const TravelQuestions::Column& asked,
                                            const std::vector<bool>& any_heading, const StopCondition& stop) {
    std::vector<std::optional<Travel>> ways(asked.robots.size());
    if (asked.robots.empty() || !may_stay_at(instance_, asked.robots.front(), asked.goal.position))
      return ways;
    SearchSpace space(instance_, asked.robots.front(), asked.goal);
    for (std::size_t k = 0; k < ways.size() && !stop.met(); ++k) {
      const std::size_t robot = asked.robots[k];
      space.begin_at(robot, any_heading[robot]);
      const auto way = this->way(space, stop);
      if (way && way->seconds < instance_.views(robot).longest_plan()) ways[k] = way;
    }
    return ways;
  }

 private:
  std::optional<Travel> way(SearchSpace& space, const StopCondition& stop) {
    const Vertices& vertices = space.vertices();
    const double heading = space.heading_at_start();
    const Vertices::GoalPose& goal = vertices.goals().front();
    if (vertices.start() == goal.vertex) {
      if (!goal.heading || space.any_heading_at_start()) return Travel{0.0, 0.0};
      const Position place = vertices.position(goal.vertex);
      return Travel{vertices.times().rotation_time(place, heading, *goal.heading), 0.0};
    }
    CostToGo& costs = space.cost_to_go(0);
    const CostToGo::Estimate estimate = costs.from(vertices.start(), stop);
    // A search that was stopped has no estimate of a whole way.
    if (estimate.least() == kForever || stop.met()) return std::nullopt;
    const double seconds =
        space.any_heading_at_start() ? estimate.least() : estimate.with_rotation(heading, vertices.body());
    // In zones that limit speeds, the estimate is not the time of a whole way.
    const bool is_whole = !vertices.times().limit_speeds();
    const SearchResult found = search_.run(space, kExact, stop);
    if (found.trajectory && (!is_whole || found.trajectory->cost <= seconds)) {
      return Travel{found.trajectory->cost, metres_of(*found.trajectory)};
    }
    if (!is_whole) return std::nullopt;
    return Travel{seconds, costs.metres(vertices.start())};
  }

  const Instance instance_;
  const ReservationTable nobody_;
  AaSipp search_;
};

/// What the threads need that compute columns at the moment: as much as there are threads, not columns.
class SpareTravels {
 public:
  SpareTravels(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
      : problem_(problem), options_(options), stop_(stop) {
    spare_.push_back(std::make_unique<Travels>(problem, options, nullptr, stop));
    fixed_ = spare_.front()->instance().fixed_reservations();
  }

  std::unique_ptr<Travels> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!spare_.empty()) {
        auto one = std::move(spare_.back());
        spare_.pop_back();
        return one;
      }
    }
    return std::make_unique<Travels>(problem_, options_, fixed_, stop_);
  }

  void give_back(std::unique_ptr<Travels> one) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(one));
  }

 private:
  const Problem& problem_;
  const PlanOptions& options_;
  const StopCondition& stop_;
  std::shared_ptr<const FixedReservations> fixed_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Travels>> spare_;
};

}  // namespace

std::optional<TravelAnswers> travel_times(const Problem& problem, const PlanOptions& options,
                                          const TravelQuestions& questions, const StopCondition& stop,
                                          Executor& executor, const std::function<bool()>& go_on) {
  SharedTurn turn(stop.despite_memory(), go_on);
  const StopCondition patience = turn.stop();
  MemoryAccount* account = MemoryScope::current();
  TravelAnswers answers(questions.columns.size());
  SpareTravels travels(problem, options, patience);
  std::atomic<bool> is_cut = false;
  executor.run(answers.size(), [&](std::size_t k) {
    const MemoryScope scope(account);
    if (patience.met()) is_cut = true;
    if (is_cut) return;
    auto mine = travels.take();
    answers[k] = mine->column(questions.columns[k], questions.any_heading, patience);
    travels.give_back(std::move(mine));
    if (patience.met()) is_cut = true;
  });
  if (is_cut) return std::nullopt;
  return answers;
}

namespace {

/// The pose from which a way begins.
struct WayBegin {
  Pose pose;
  bool any_heading = false;
  bool is_start = false;  // where a robot is; it may be inside of a zone that it may leave
};

/// A way that has been asked for.
struct Leg {
  std::size_t kind = 0;
  std::size_t column = 0;
  std::size_t row = 0;
};

/// The ways of robots that are alike: they move in the same way and are in the same zones.
class Kind {
 public:
  /// Robots like this one of a problem, while it carries this load.
  Kind(std::size_t like, const Load& load) : like_(like), load_(load) {}

  /// Returns the column and the row of the way.
  std::pair<std::size_t, std::size_t> ask(const WayBegin& from, const Goal& to) {
    const std::size_t robot = begin_of(from);
    const GoalKey key{to.position.x(), to.position.y(), to.theta};
    const auto [found, is_new] = columns_.emplace(key, questions_.columns.size());
    if (is_new) questions_.columns.push_back({{to.position, to.theta}, {}});
    std::vector<std::size_t>& rows = questions_.columns[found->second].robots;
    rows.push_back(robot);
    return {found->second, rows.size() - 1};
  }

  /// Returns false if the stop is met first, or if `go_on` ends it.
  bool compute(const Problem& problem, const PlanOptions& options, const StopCondition& stop,
               Executor& executor, const std::function<bool()>& go_on) {
    if (begins_.empty()) return true;
    const auto alone = make_problem(problem, options, stop);
    if (!alone) return false;
    auto answers = travel_times(*alone, options, questions_, stop, executor, go_on);
    if (answers) answers_ = std::move(*answers);
    return answers.has_value();
  }

  double seconds(const Leg& leg) const {
    const std::optional<Travel>& way = answers_[leg.column][leg.row];
    return way ? way->seconds : kForever;
  }

 private:
  using StartKey = std::tuple<double, double, double, bool, bool>;
  using GoalKey = std::tuple<double, double, std::optional<double>>;

  std::size_t begin_of(const WayBegin& from) {
    const Position& position = from.pose.position;
    const double heading = from.any_heading ? 0.0 : from.pose.theta;
    const StartKey key{position.x(), position.y(), heading, from.any_heading, from.is_start};
    const auto [found, is_new] = known_begins_.emplace(key, begins_.size());
    if (!is_new) return found->second;
    begins_.push_back(from);
    questions_.any_heading.push_back(from.any_heading);
    return found->second;
  }

  /// A robot for each pose from which a way begins. Robots at goals are not checked, and have no way where
  /// they do not fit.
  std::vector<Robot> robots(const Robot& like, bool checks_starts) const {
    std::vector<Robot> robots;
    for (const WayBegin& from : begins_) {
      Robot& robot = robots.emplace_back();
      set_load(robot, load_);
      robot.angular_speed = like.angular_speed;
      robot.may_reverse = like.may_reverse;
      robot.angular_acceleration = like.angular_acceleration;
      robot.start = from.pose;
      robot.goal = Goal{from.pose.position, std::nullopt};  // a robot that has a goal gets a way out of zones
      robot.invalid = !checks_starts || !from.is_start;
    }
    return robots;
  }

  /// The robots of all these poses, one at a time.
  std::optional<Problem> make_problem(const Problem& problem, const PlanOptions& options,
                                      const StopCondition& stop) const {
    // The second time, for a robot that touches more where it is than any robot may at a goal.
    for (const bool checks_starts : {true, false}) {
      ProblemConditions conditions = conditions_of(options);
      for (const Zone& zone : problem.zones()) {
        if (!zone.is_for(like_)) continue;
        conditions.zones.push_back(zone);
        conditions.zones.back().robots.clear();
      }
      conditions.one_at_a_time = true;
      auto made = Problem::create(problem.map(), robots(problem.robots()[like_], checks_starts),
                                  std::move(conditions), stop);
      if (auto* valid = std::get_if<Problem>(&made)) return std::move(*valid);
      if (stop.met()) break;
    }
    return std::nullopt;
  }

  std::size_t like_;
  Load load_;
  std::vector<WayBegin> begins_;
  std::map<StartKey, std::size_t> known_begins_;
  std::map<GoalKey, std::size_t> columns_;
  TravelQuestions questions_;
  TravelAnswers answers_;
};

/// The ways of all robots, first asked for and then computed.
class Legs {
 public:
  explicit Legs(const Problem& problem) : problem_(problem) {}

  /// The kind of a robot of the problem while it carries this load.
  std::size_t kind_of(std::size_t robot, const Load& load) {
    const Robot& like = problem_.robots()[robot];
    std::vector<std::size_t> zones;
    for (std::size_t k = 0; k < problem_.zones().size(); ++k) {
      if (problem_.zones()[k].is_for(robot)) zones.push_back(k);
    }
    const Key key{load, like.angular_speed, like.angular_acceleration, like.may_reverse, zones};
    const auto [found, is_new] = known_.emplace(key, kinds_.size());
    if (!is_new) return found->second;
    kinds_.emplace_back(robot, load);
    return found->second;
  }

  Leg ask(std::size_t kind, const WayBegin& from, const Goal& to) {
    const auto [column, row] = kinds_[kind].ask(from, to);
    return {kind, column, row};
  }

  bool compute(const PlanOptions& options, const StopCondition& stop, Executor& executor,
               const std::function<bool()>& go_on) {
    return std::all_of(kinds_.begin(), kinds_.end(),
                       [&](Kind& kind) { return kind.compute(problem_, options, stop, executor, go_on); });
  }

  double seconds(const Leg& leg) const { return kinds_[leg.kind].seconds(leg); }

 private:
  using Key = std::tuple<Load, double, double, bool, std::vector<std::size_t>>;

  const Problem& problem_;
  std::vector<Kind> kinds_;
  std::map<Key, std::size_t> known_;
};

/// A way to a goal and the service there.
struct Step {
  Leg leg;
  double service = 0.0;     // seconds
  double not_before = 0.0;  // seconds
  bool only_fits = false;   // no way: the robot has another radius from here on, and has to fit
};

/// When a robot comes to rest at a goal, and when it leaves.
struct Rest {
  double t_rest = 0.0;
  double t_leave = 0.0;

  void go_on(double seconds, const Step& step) {
    t_rest = (step.only_fits ? t_rest : t_leave) + seconds;
    t_leave = step.only_fits ? t_leave + seconds : std::max(t_rest, step.not_before) + step.service;
  }
};

/// A robot on its way from goal to goal.
struct Traveller {
  std::size_t robot = 0;  // of the problem
  Load load;
  WayBegin at;
};

/// The arrivals of all robots at the end of all tasks.
class Arrivals {
 public:
  Arrivals(const Problem& problem, const std::vector<Task>& tasks)
      : problem_(problem), tasks_(tasks), legs_(problem) {}

  std::optional<std::vector<std::vector<double>>> run(const PlanOptions& options, const StopCondition& stop,
                                                      Executor& executor,
                                                      const std::function<bool()>& go_on) {
    if (!ask_for_all(stop) || !legs_.compute(options, stop, executor, go_on)) return std::nullopt;
    std::vector<std::vector<double>> arrivals;
    for (std::size_t task = 0; task < tasks_.size(); ++task) {
      arrivals.emplace_back();
      for (const std::size_t robot : tasks_[task].robots) {
        if (stop.met()) return std::nullopt;
        arrivals.back().push_back(arrival(task, robot));
      }
    }
    return arrivals;
  }

 private:
  struct Own {
    bool takes_part = false;
    double t_begin = 0.0;          // seconds
    std::optional<double> rested;  // seconds: since then it rests in the pose of its first goal
    std::vector<Step> steps;
    Traveller at_end;
    std::size_t kind = 0;  // at the end
  };

  /// Returns false if the stop is met first.
  bool ask_for_all(const StopCondition& stop) {
    for (std::size_t robot = 0; robot < problem_.robots().size(); ++robot) {
      if (stop.met()) return false;
      own_.push_back(own(robot));
    }
    for (std::size_t task = 0; task < tasks_.size(); ++task) {
      first_.emplace_back();
      for (const std::size_t robot : tasks_[task].robots) {
        if (stop.met()) return false;
        const Own& own = own_[robot];
        first_.back().emplace_back();
        if (!own.takes_part) continue;
        first_.back().back() = legs_.ask(own.kind, own.at_end.at, tasks_[task].goals.front());
        ask_for_rest(task, own);
      }
    }
    return true;
  }

  /// The robot until it has served the goals that it has.
  Own own(std::size_t index) {
    const Robot& robot = problem_.robots()[index];
    const Leaving* leaving = problem_.leaving(index);
    Own own;
    own.takes_part = !robot.invalid && (leaving == nullptr || !leaving->postponed);
    if (!own.takes_part) return own;
    const Itinerary itinerary = itinerary_of(robot);
    own.t_begin = itinerary.t_begin;
    own.at_end = {index, loads_of(robot)[itinerary.first_goal], {itinerary.pose, false, true}};
    if (!robot.committed.empty() && !itinerary.goals.empty() &&
        is_in_pose(itinerary.pose, itinerary.goals.front())) {
      own.rested = itinerary.arrived;
    }
    for (const Goal& goal : itinerary.goals) {
      if (!goal.anywhere) visit(goal, own.at_end, own.steps);
    }
    own.kind = legs_.kind_of(index, own.at_end.load);
    return own;
  }

  /// The ways from the first goal of a task on are the same for all robots of a kind.
  void ask_for_rest(std::size_t task, const Own& own) {
    const auto [found, is_new] = rest_.try_emplace({own.kind, task});
    if (!is_new) return;
    const std::vector<Goal>& goals = tasks_[task].goals;
    Traveller traveller = own.at_end;
    leave(goals.front(), traveller, found->second);
    for (std::size_t k = 1; k < goals.size(); ++k) visit(goals[k], traveller, found->second);
  }

  void visit(const Goal& goal, Traveller& traveller, std::vector<Step>& steps) {
    const Leg leg = legs_.ask(legs_.kind_of(traveller.robot, traveller.load), traveller.at, goal);
    steps.push_back({leg, goal.service, goal.not_before});
    leave(goal, traveller, steps);
  }

  /// After the service. A robot that becomes larger has to fit there.
  void leave(const Goal& goal, Traveller& traveller, std::vector<Step>& steps) {
    traveller.at = {{goal.position, goal.theta.value_or(0.0)}, !goal.theta, false};
    const double radius = traveller.load.radius;
    traveller.load = load_after(traveller.load, goal);
    if (traveller.load.radius == radius) return;
    const std::size_t kind = legs_.kind_of(traveller.robot, traveller.load);
    steps.push_back({legs_.ask(kind, traveller.at, goal), 0.0, 0.0, true});
  }

  double arrival(std::size_t task, std::size_t robot) const {
    const Own& own = own_[robot];
    if (!own.takes_part) return kForever;
    Rest at{own.t_begin, own.t_begin};
    for (const Step& step : own.steps) {
      const bool rests = own.rested && &step == &own.steps.front();
      at.go_on(rests ? *own.rested - own.t_begin : legs_.seconds(step.leg), step);
    }
    const std::vector<std::size_t>& robots = tasks_[task].robots;
    const auto row = std::lower_bound(robots.begin(), robots.end(), robot) - robots.begin();
    const Goal& first = tasks_[task].goals.front();
    at.go_on(legs_.seconds(first_[task][static_cast<std::size_t>(row)]),
             {{}, first.service, first.not_before});
    for (const Step& step : rest_.at({own.kind, task})) at.go_on(legs_.seconds(step.leg), step);
    return at.t_rest;
  }

  const Problem& problem_;
  const std::vector<Task>& tasks_;
  Legs legs_;
  std::vector<Own> own_;                                                   // by robot
  std::vector<std::vector<Leg>> first_;                                    // by task, as in Task::robots
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Step>> rest_;  // by kind and task
};

}  // namespace

std::optional<std::vector<std::vector<double>>> arrivals(const Problem& problem, const PlanOptions& options,
                                                         const std::vector<Task>& tasks,
                                                         const StopCondition& stop, Executor& executor,
                                                         const std::function<bool()>& go_on) {
  return Arrivals(problem, tasks).run(options, stop, executor, go_on);
}

}  // namespace fleetplan::core
