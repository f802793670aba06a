#include "api/vda5050/node_actions.h"

#include <algorithm>
#include <cstdint>

namespace fleetplan::api {

namespace {

/// Adds the actions that the client has given a goal; none if it has not.
void add_given(const JsonReader& goal, std::vector<NodeAction>& actions) {
  for (const JsonReader given : goal.find("actions").items()) {
    actions.push_back({.type = given.find("type").string().value_or(""),
                       .blocking_type = given.find("blocking_type").string().value_or("HARD"),
                       .parameters = given.find("parameters")});
  }
}

}  // namespace

std::vector<NodeAction> actions_of(const VdaRequest& request, std::size_t robot, const RouteNode& node) {
  std::vector<NodeAction> actions;
  const std::vector<JsonReader>& goals = request.goals[robot];
  // Bounded: the actions in the body, of goals that occur in one stop each.
  for (const Stop& stop : node.stops) {
    std::vector<NodeAction> given;
    if (stop.goal && *stop.goal < goals.size()) add_given(goals[*stop.goal], given);
    Stop own = stop;
    if (!given.empty()) own.duration = 0.0;
    if (given.empty() || own.not_before > 0.0) {
      actions.push_back(
          {.type = stop.goal ? "fleetplanService" : "fleetplanWait", .parameters = {}, .stop = own});
    }
    actions.insert(actions.end(), given.begin(), given.end());
  }
  return actions;
}

OrderNames::OrderNames(const VdaRequest& request, std::size_t robot, std::string_view order_id)
    : name_(request.robots[robot].id + "-"), action_(std::string(order_id) + "-") {
  const auto& base = request.bases[robot];
  if (!base) return;
  const std::string update = std::to_string(base->update_id + 1) + "-";
  name_ += update;
  action_ += update;
}

}  // namespace fleetplan::api
