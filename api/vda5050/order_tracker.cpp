#include "api/vda5050/order_tracker.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/position.h"

namespace fleetplan::api {

namespace {

/// Distances that differ by less are the same (metres): the earlier place counts.
constexpr double kSameDistance = 1e-9;

/// The place within these actions that is nearest to a position, where the path comes near it for the first
/// time. If there are several, the earliest one. None if no place is nearer than kBesidePath.
std::optional<core::ActionPlace> nearest_place(core::Actions actions, const core::ActionPlace& from,
                                               const core::ActionPlace& to, const core::Position& position,
                                               core::Work& work) {
  constexpr std::size_t kWorkOfALook = 64;
  std::optional<core::ActionPlace> nearest;
  double least = (position_at(actions, from) - position).norm();
  if (least <= kBesidePath) nearest = from;
  least = std::min(least, kBesidePath);
  for (std::size_t k = from.action; k < actions.size() && k <= to.action; ++k) {
    if (work.met_after(kWorkOfALook)) break;
    const core::Position path = actions[k].to.position - actions[k].from.position;
    const double squared = path.squaredNorm();
    const double first = k == from.action ? from.fraction : 0.0;
    const double last = k == to.action ? to.fraction : 1.0;
    if (squared <= 0.0 || last <= first) continue;
    const double along = (position - actions[k].from.position).dot(path) / squared;
    const double fraction = std::clamp(along, first, last);
    const double distance = (actions[k].from.position + fraction * path - position).norm();
    if (distance < least - kSameDistance) {
      least = distance;
      nearest = core::place_of({0, k, fraction});
    }
    const core::Position end = actions[k].from.position + last * path;
    if (nearest && (end - position).norm() > kBesidePath) break;  // it may come back later
  }
  return nearest;
}

}  // namespace

core::Position position_at(core::Actions actions, const core::ActionPlace& place) {
  if (place.action >= actions.size()) return actions.back().to.position;
  const core::Action& action = actions[place.action];
  return action.from.position + place.fraction * (action.to.position - action.from.position);
}

OrderTracker::OrderTracker(const VdaRequest& request, std::size_t robot, const VehicleState* state,
                           core::Work& work)
    : request_(request),
      robot_(robot),
      state_(state),
      work_(work),
      progress_(request.progress[robot]),
      route_(request.routes[robot]),
      actions_(request.actions[robot]),
      end_(find_end()),
      served_(std::min(progress_.served, request.robots[robot].goal_count())) {
  if (progress_.order_id && state_ != nullptr && state_->order_id == *progress_.order_id &&
      !state_->failed_actions.empty()) {
    find_failed_actions();
    find_failed_actions_of_base();
  }
  if (is_of_order() && !state_->finished_actions.empty()) {
    served_ = std::max(served_, std::min(find_served_goals().count, goals_before_failure()));
  }
}

bool OrderTracker::is_of_order() const {
  return state_ != nullptr && state_->is_readable && progress_.order_id &&
         state_->order_id == *progress_.order_id && state_->update_id <= progress_.update_id;
}

bool OrderTracker::counts() const {
  if (!is_of_order() || !state_->is_localized || state_->other_map) return false;
  return state_->control == Control::fleet || is_at_rest_at_end();
}

/// Whether it has finished its order, and is still there: then it does not matter who is in control.
bool OrderTracker::is_at_rest_at_end() const {
  if (actions_.empty() || route_.nodes.empty() || !is_up_to_date() || !state_->has_no_nodes) return false;
  const std::size_t last = route_.nodes.size() - 1;
  if (reached() != last || outcome(last) != Outcome::done) return false;
  return !state_->pose || (state_->pose->position - actions_.back().to.position).norm() <= kBesidePath;
}

OrderEnd OrderTracker::find_end() const {
  if (!progress_.order_id || state_ == nullptr || !state_->is_readable) return OrderEnd::none;
  if (is_cancelled()) return OrderEnd::cancelled;
  if (is_cleared()) return OrderEnd::cleared;
  return is_forgotten() ? OrderEnd::forgotten : OrderEnd::none;
}

bool OrderTracker::is_cancelled() const {
  if (!progress_.cancel_id) return false;
  if (state_->finished_actions.contains(*progress_.cancel_id)) return true;
  // It fails where there is nothing to cancel; a vehicle that still has nodes to reach goes on.
  const bool has_failed = state_->failed_actions.contains(*progress_.cancel_id);
  return (has_failed || state_->has_no_order_to_cancel) && !state_->next_sequence_id;
}

/// Whether it has dropped the order before its end. In modes that clear orders, there are no nodes to reach
/// any more; in others, the vehicle also has to stand.
bool OrderTracker::is_cleared() const {
  if (!is_up_to_date() || !state_->has_no_nodes) return false;
  if (!state_->clears_orders && !(state_->is_idle && state_->control == Control::fleet)) return false;
  if (state_->last_sequence_id != progress_.last_released) return true;
  const auto& base = request_.bases[robot_];
  const bool is_as_before = base && base->update_id == progress_.update_id;
  const auto node = route_.node_of(progress_.last_released);
  return is_as_before ? base->has_horizon : node && *node + 1 < route_.nodes.size();
}

/// Whether it reports no order, although it has reported of this one.
bool OrderTracker::is_forgotten() const {
  const auto& base = request_.bases[robot_];
  const bool was_known = core::ActionPlace{} < progress_.at || (base && base->is_known);
  return was_known && state_->order_id.empty() && !state_->next_sequence_id;
}

bool OrderTracker::has_arrived() const {
  if (actions_.empty() || route_.nodes.empty()) return true;
  const std::size_t last = route_.nodes.size() - 1;
  const RouteNode& end = route_.nodes.back();
  if (has_order() ? !failed_.empty() : place_to_plan_from(progress_.at) < progress_.at) return false;
  if (has_order() && counts()) return reached() == last && outcome(last) == Outcome::done;
  return !(progress_.at < (end.stops.empty() ? end.at : end.until));
}

core::ActionPlace OrderTracker::place() const {
  core::ActionPlace place = progress_.at;
  if (!has_order() || !counts() || route_.nodes.empty()) return place;
  const auto node = reached();
  core::ActionPlace most = last_stand(actions_.first(committed()));
  if (node) {
    place = std::max(place, place_at(*node));
    const bool is_last = *node + 1 == route_.nodes.size();
    most = is_last ? place : route_.nodes[*node + 1].at;
  }
  const bool is_busy = node && outcome(*node) == Outcome::under_way;
  if (!state_->pose || is_busy || !(place < most)) return place;
  return nearest_place(actions_, place, most, state_->pose->position, work_).value_or(place);
}

core::ActionPlace OrderTracker::place_to_plan_from(const core::ActionPlace& place) const {
  core::ActionPlace first = std::max(place, behind_served_goals());
  for (const FailedAction& action : failed_) {
    if (action.at) first = std::min(first, *action.at);
  }
  return first;
}

core::ActionPlace OrderTracker::released(const core::ActionPlace& place) const {
  const auto node = route_.node_of(progress_.last_released);
  return node ? std::max(place, route_.nodes[*node].until) : place;
}

std::size_t OrderTracker::committed() const {
  return route_.nodes.empty() ? 0 : std::min(route_.nodes.front().at.action, actions_.size());
}

/// The last node of the route that it has reached. None if it has not come to the first node yet.
std::optional<std::size_t> OrderTracker::reached() const {
  const auto& last = state_->last_sequence_id;
  // A vehicle that has just taken an order may still report the last node of the previous order.
  const bool is_stale = !last || (state_->next_sequence_id && *state_->next_sequence_id <= *last);
  return is_stale ? std::nullopt : route_.node_of(*last);
}

/// Where a vehicle is that has come to a node, and has done nothing there yet.
core::ActionPlace OrderTracker::arrival_at(std::size_t node) const {
  if (is_of_base(node)) return last_stand(actions_.first(committed()));
  const RouteNode& at = route_.nodes[node];
  return node > 0 ? std::max(at.at, route_.nodes[node - 1].until) : at.at;
}

/// Where a vehicle is that stands at a node. What has failed is not done.
core::ActionPlace OrderTracker::place_at(std::size_t node) const {
  const RouteNode& at = route_.nodes[node];
  const core::ActionPlace before = arrival_at(node);
  if (outcome(node) != Outcome::done) return before;
  if (is_of_base(node)) return at.at;
  return at.stops.empty() ? before : std::max(before, at.until);
}

/// The ids of the actions of a node.
std::vector<std::string> OrderTracker::action_ids(std::size_t node) const {
  std::vector<std::string> ids;
  if (is_of_base(node)) {
    const JsonReader actions = request_.bases[robot_]->last.find("actions");
    // Bounded: the actions in the body.
    for (const JsonReader action : actions.items()) {
      ids.emplace_back(action.find("actionId").string().value_or(""));
    }
    return ids;
  }
  const std::size_t count = actions_of(request_, robot_, route_.nodes[node]).size();
  const OrderNames names(request_, robot_, *progress_.order_id);
  for (std::size_t k = 0; k < count; ++k) ids.push_back(names.action(route_.sequence_id(node), k));
  return ids;
}

OrderTracker::Outcome OrderTracker::outcome(std::size_t node) const {
  bool has_failed = false;
  for (const std::string& id : action_ids(node)) {
    const bool failed = state_->failed_actions.contains(id);
    if (!failed && !state_->finished_actions.contains(id)) return Outcome::under_way;
    has_failed = has_failed || failed;
  }
  return has_failed ? Outcome::failed : Outcome::done;
}

void OrderTracker::find_failed_actions() {
  constexpr std::size_t kWorkOfANode = 256;
  const OrderNames names(request_, robot_, *progress_.order_id);
  const std::size_t first = request_.bases[robot_] ? 1 : 0;
  for (std::size_t node = first; node < route_.nodes.size(); ++node) {
    if (work_.met_after(kWorkOfANode)) return;
    if (route_.nodes[node].stops.empty()) continue;
    std::size_t index = 0;
    for (const NodeAction& action : actions_of(request_, robot_, route_.nodes[node])) {
      std::string id = names.action(route_.sequence_id(node), index++);
      if (!action.goal || !state_->failed_actions.contains(id)) continue;
      failed_.push_back({std::move(id), action.goal, arrival_at(node)});
    }
  }
}

namespace {

core::Position position_of(const JsonReader& node) {
  const JsonReader position = node.find("nodePosition");
  return {position.find("x").value().number().value_or(0.0),
          position.find("y").value().number().value_or(0.0)};
}

/// The id of an action that serves a goal. None for an action that only waits.
std::optional<std::string_view> service_id(const JsonReader& action) {
  if (action.find("actionType").string() == "fleetplanWait") return std::nullopt;
  return action.find("actionId").string();
}

bool is_near(const core::Position& a, const core::Position& b) { return (a - b).norm() <= kSameNode; }

}  // namespace

/// Of released nodes of an order that the plan goes on with: their services are among the committed actions.
void OrderTracker::find_failed_actions_of_base() {
  const auto& base = request_.bases[robot_];
  if (!base) return;
  const core::Actions committed_actions = actions_.first(committed());
  for (const JsonReader& node : base->released) {
    const core::Position at = position_of(node);
    // Bounded: the actions in the body.
    for (const JsonReader action : node.find("actions").items()) {
      const auto id = service_id(action);
      if (!id || !state_->failed_actions.contains(*id)) continue;
      FailedAction& failed = failed_.emplace_back(FailedAction{std::string(*id)});
      if (work_.met_after(committed_actions.size())) return;
      for (std::size_t k = 0; k < committed_actions.size() && !failed.goal; ++k) {
        const core::Action& wait = committed_actions[k];
        if (!wait.goal || !is_near(wait.from.position, at)) continue;
        failed.goal = wait.goal;
        failed.at = core::ActionPlace{k, 0.0};
      }
    }
  }
}

std::size_t OrderTracker::goals_before_failure() const {
  std::size_t count = request_.robots[robot_].goal_count();
  for (const FailedAction& action : failed_) {
    if (action.goal) count = std::min(count, *action.goal);
  }
  return count;
}

/// By the actions of released nodes, which are done one after the other.
FinishedGoals OrderTracker::find_served_goals() const {
  constexpr std::size_t kWorkOfANode = 256;
  FinishedGoals found = find_served_goals_of_base();
  const OrderNames names(request_, robot_, *progress_.order_id);
  for (std::size_t node = request_.bases[robot_] ? 1 : 0; found.are_all && node < route_.nodes.size();
       ++node) {
    if (work_.met_after(kWorkOfANode) || route_.sequence_id(node) > progress_.last_released) break;
    if (route_.nodes[node].stops.empty()) continue;
    std::size_t index = 0;
    for (const NodeAction& action : actions_of(request_, robot_, route_.nodes[node])) {
      const std::string id = names.action(route_.sequence_id(node), index++);
      if (!action.goal) continue;
      if (!state_->finished_actions.contains(id)) return {std::min(found.count, *action.goal), false};
      found.count = *action.goal + 1;
    }
  }
  return found;
}

namespace {

/// Actions of a node of an order that serve goals.
struct NodeServices {
  core::Position at;
  std::vector<std::string_view> ids = {};
};

/// The services of a base that its vehicle had not finished when the plan began.
std::vector<NodeServices> services_left(const OrderBase& base) {
  std::vector<NodeServices> services;
  for (const JsonReader& node : base.released) {
    NodeServices of_node{position_of(node)};
    bool are_finished = true;
    // Bounded: the actions in the body.
    for (const JsonReader action : node.find("actions").items()) {
      const auto id = service_id(action);
      if (!id) continue;
      of_node.ids.push_back(*id);
      are_finished = are_finished && base.finished.contains(*id);
    }
    if (!are_finished) services.push_back(std::move(of_node));
  }
  return services;
}

}  // namespace

/// What the base had left is committed. Its services are the services of the committed actions, in their
/// order.
FinishedGoals OrderTracker::find_served_goals_of_base() const {
  FinishedGoals found;
  const auto& base = request_.bases[robot_];
  if (!base) return found;
  const core::Actions actions = actions_.first(committed());
  const std::vector<NodeServices> services = services_left(*base);
  if (work_.met_after(actions.size() + services.size())) return {0, false};
  auto action = actions.begin();
  const auto is_done = [&](std::string_view id) { return state_->finished_actions.contains(id); };
  for (std::size_t k = 0; k < services.size(); ++k) {
    const core::Position& at = services[k].at;
    const bool is_alone = k + 1 == services.size() || !is_near(services[k + 1].at, at);
    const auto serves = [&](const core::Action& wait) {
      return wait.goal && is_near(wait.from.position, at);
    };
    action = std::find_if(action, actions.end(), serves);
    const bool are_done = std::all_of(services[k].ids.begin(), services[k].ids.end(), is_done);
    if (action == actions.end() || !are_done) return {found.count, false};
    // A node serves one goal, or all that are in its place.
    const std::size_t first = *action->goal;
    for (; action != actions.end() && is_near(action->to.position, at); ++action) {
      if (!action->goal) continue;
      if (!is_alone && *action->goal != first) break;
      found.count = *action->goal + 1;
    }
  }
  return found;
}

core::ActionPlace OrderTracker::behind_served_goals() const {
  const auto is_served = [&](const core::Action& action) { return action.goal && *action.goal < served_; };
  const auto last = std::find_if(actions_.rbegin(), actions_.rend(), is_served);
  return {static_cast<std::size_t>(actions_.rend() - last), 0.0};
}

}  // namespace fleetplan::api
