#include <fleetplan/service.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/request_context.h"
#include "api/json/errors.h"
#include "api/request/limits.h"
#include "api/response/reply.h"
#include "library/convert.h"

namespace fleetplan {

namespace {

using EndpointFunction = api::Reply (*)(std::string_view, const api::RequestContext&);

EndpointFunction function_of(Endpoint endpoint) {
  switch (endpoint) {
    case Endpoint::plan:
      return api::plan_endpoint;
    case Endpoint::validate:
      return api::validate_endpoint;
    case Endpoint::dependencies:
      return api::dependencies_endpoint;
    case Endpoint::advance:
      return api::advance_endpoint;
    case Endpoint::simulate:
      return api::simulate_endpoint;
    case Endpoint::margins:
      return api::margins_endpoint;
    case Endpoint::retime:
      return api::retime_endpoint;
    case Endpoint::matrix:
      return api::matrix_endpoint;
    case Endpoint::assign:
      return api::assign_endpoint;
    case Endpoint::export_vda5050:
      return api::vda5050_endpoint;
    case Endpoint::import_vda5050:
      return api::import_vda5050_endpoint;
  }
  throw std::invalid_argument("there is no such endpoint");
}

api::Limits limits_of(const ServiceLimits& limits) {
  // As the settings of the service.
  constexpr std::chrono::hours kLongestBudget{24};
  constexpr std::int64_t kMaxCells = 1'000'000'000;
  if (limits.default_budget < std::chrono::milliseconds(1) || limits.default_budget > limits.max_budget ||
      limits.max_budget > kLongestBudget) {
    throw std::invalid_argument("the budgets are not 1 ms <= default_budget <= max_budget <= 1 day");
  }
  if (limits.max_cells < 1 || limits.max_cells > kMaxCells) {
    throw std::invalid_argument("max_cells is not from 1 to 1e9");
  }
  return {.max_body = limits.max_body,
          .max_cells = limits.max_cells,
          .max_robots = limits.max_robots,
          .max_goals = limits.max_goals,
          .max_actions = limits.max_actions,
          .max_obstacles = limits.max_obstacles,
          .max_obstacle_entries = limits.max_obstacle_entries,
          .max_zones = limits.max_zones,
          .max_zone_corners = limits.max_zone_corners,
          .max_plan_memory = limits.max_plan_memory,
          .default_budget_ms = limits.default_budget.count(),
          .max_budget_ms = limits.max_budget.count()};
}

/// Passes on the progress of planning.
class ProgressEvents final : public api::PlanEvents {
 public:
  explicit ProgressEvents(const std::function<void(const Progress&)>& progress) : progress_(progress) {}

  void begin(const api::PlanProgress& /*progress*/) override {}
  void progress(const api::PlanProgress& progress) override {
    progress_(library::progress_of(progress.planner));
  }
  bool wants_incumbents() const override { return false; }
  void incumbent(std::string /*answer*/) override {}

 private:
  const std::function<void(const Progress&)>& progress_;
};

api::Reply too_large(std::string_view body, const api::RequestContext& context) {
  return api::problem_reply(api::ErrorCode::body_too_large,
                            api::too_large_body_detail(std::to_string(body.size()), context.limits.max_body),
                            context.request_id);
}

}  // namespace

Answer answer(Endpoint endpoint, std::string_view body, const Control& control,
              const ServiceOptions& options) {
  const EndpointFunction function = function_of(endpoint);
  api::RequestContext context;
  context.request_id = options.request_id;
  context.stop = control.stop;
  context.limits = limits_of(options.limits);
  std::optional<ProgressEvents> events;
  if (control.progress && endpoint == Endpoint::plan) context.events = &events.emplace(control.progress);
  api::Reply reply =
      body.size() <= context.limits.max_body ? function(body, context) : too_large(body, context);
  return {reply.status, std::move(reply.body)};
}

}  // namespace fleetplan
