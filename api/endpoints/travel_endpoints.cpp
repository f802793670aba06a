#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "api/json/error.h"
#include "api/request/parse_body.h"
#include "api/travel/assign_request.h"
#include "api/travel/matrix_request.h"
#include "core/geometry/segment.h"
#include "core/runtime/executor.h"
#include "core/travel/arrivals.h"
#include "core/travel/travel_times.h"

namespace fleetplan::api {

namespace {

/// The computation of travel times for one request, in its turn. A reply that it has instead of an answer is
/// kept until the reading of the body has ended.
class Travelling {
 public:
  Travelling(const RequestContext& context, core::Work& work) : context_(context), work_(work) {}

  /// Waits for the turn of a request of so many pairs; returns false if it does not come.
  bool begin(std::size_t pairs, std::chrono::nanoseconds budget) {
    constexpr std::chrono::milliseconds kAnswerTime{100};
    constexpr std::size_t kFewPairs = 100;
    budget_ = budget;
    stop_ = work_.before_end(std::min<std::chrono::nanoseconds>(budget / 10, kAnswerTime));
    const TurnNeed need{.kind = TurnNeed::Kind::travel,
                        .stop = *stop_,
                        .answer_by = stop_->deadline(),
                        .work = static_cast<double>(std::max<std::size_t>(1, pairs)),
                        .is_short = pairs <= kFewPairs};
    if (take_turn(context_.turn, need, work_)) return true;
    if (!work_.cancelled()) reply_ = too_busy(context_.request_id);
    return false;
  }

  const core::StopCondition& stop() const { return *stop_; }
  core::Executor& executor() { return context_.executor != nullptr ? *context_.executor : callers_thread_; }
  std::function<bool()> go_on() const {
    return [turn = context_.turn] { return turn == nullptr || turn->let_others(); };
  }

  /// Keeps the reply that the time did not suffice, and returns nothing. `what` and `fewer`: see
  /// unfinished_reply.
  std::optional<std::string> unfinished(std::string_view what, std::string_view fewer) {
    reply_ = unfinished_reply(what, fewer, budget_, *stop_, context_);
    return std::nullopt;
  }
  const std::optional<Reply>& reply() const { return reply_; }

 private:
  const RequestContext& context_;
  core::Work& work_;
  core::CallerThread callers_thread_;
  std::chrono::nanoseconds budget_{};
  std::optional<core::StopCondition> stop_;
  std::optional<Reply> reply_;
};

using MakeTravelAnswer =
    std::function<std::optional<std::string>(const JsonReader&, core::Work&, Travelling&)>;

Reply travel_endpoint(std::string_view body, const RequestContext& context,
                      std::span<const std::string_view> members, const MakeTravelAnswer& make) {
  return bounded_work(context, [&](core::Work& work) -> Reply {
    Travelling travelling(context, work);
    auto text = parse_body<std::string>(
        body, context.limits, work, members,
        [&](const JsonReader& root, core::Work& reading) { return make(root, reading, travelling); });
    if (travelling.reply()) return *travelling.reply();
    if (!text) return problem_reply(text.failure(), context.request_id);
    return {200, kJson, std::move(*text)};
  });
}

}  // namespace

Reply matrix_endpoint(std::string_view body, const RequestContext& context) {
  constexpr std::string_view kWhat = "Not all travel times could be computed";
  const auto matrix = [&](const JsonReader& root, core::Work& work,
                          Travelling& travelling) -> std::optional<std::string> {
    const auto request = parse_matrix_request(root, context.limits, work, context.maps);
    if (!request || !travelling.begin(request->rows() * request->columns(), request->budget)) {
      return std::nullopt;
    }
    const auto answers = core::travel_times(request->problem, request->options, request->questions,
                                            travelling.stop(), travelling.executor(), travelling.go_on());
    auto text = answers ? write_matrix(*request, *answers, work.before_end()) : std::nullopt;
    return text ? std::move(text) : travelling.unfinished(kWhat, "poses");
  };
  return travel_endpoint(body, context, kMatrixMembers, matrix);
}

Reply assign_endpoint(std::string_view body, const RequestContext& context) {
  const auto with_goals = [&](const JsonReader& root, core::Work& work,
                              Travelling& travelling) -> std::optional<std::string> {
    const auto request = parse_assign_request(root, context.limits, work, context.maps);
    if (!request) return std::nullopt;
    const PlanRequest& plan = request->plan;
    if (!travelling.begin(plan.problem.robots().size() * request->tasks.size(), plan.budget)) {
      return std::nullopt;
    }
    const auto arrivals = core::arrivals(plan.problem, plan.options, request->tasks, travelling.stop(),
                                         travelling.executor(), travelling.go_on());
    const auto robots = arrivals ? assigned(*request, *arrivals, travelling.stop()) : std::nullopt;
    if (!robots) return travelling.unfinished("The tasks could not be assigned", "tasks");
    std::vector<bool> any_way;
    for (const std::vector<double>& of_task : *arrivals) {
      any_way.push_back(std::any_of(of_task.begin(), of_task.end(),
                                    [](double arrival) { return arrival < core::kForever; }));
    }
    return write_assigned(*request, *robots, any_way);
  };
  return travel_endpoint(body, context, kAssignMembers, with_goals);
}

}  // namespace fleetplan::api
