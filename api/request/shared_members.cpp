#include "api/request/shared_members.h"

#include <array>
#include <cmath>

#include "api/json/json_writer.h"

namespace fleetplan::api {

namespace {

/// Whether all numbers can be written as they were read. The depth of a document is limited.
bool is_finite(const JsonValue& value) {  // NOLINT(misc-no-recursion)
  if (const auto number = value.number()) return std::isfinite(*number);
  for (const JsonValue child : value.children()) {
    if (!is_finite(child)) return false;
  }
  return true;
}

/// The text of a member without spaces; an empty text if it has a fault. `what`: what the member is, for
/// messages.
std::string text_of_member(const JsonReader& member, std::string_view name, std::string_view what) {
  if (!is_finite(member.value())) {
    member.fault(fault::kOutOfRange, std::string(name) + " has a number that is too large for a double.");
    return {};
  }
  JsonWriter json;
  copy_json(json, member.value());
  std::string text = json.take();
  if (text.size() <= kMaxMetadataBytes) return text;
  member.fault(fault::kOutOfRange, std::string(name) + " has " + std::to_string(text.size()) +
                                       " bytes; this service accepts at most " +
                                       std::to_string(kMaxMetadataBytes) + " in each " + std::string(what) +
                                       ".");
  return {};
}

constexpr std::array<std::string_view, 4> kActionMembers{"type", "blocking_type", "retriable", "parameters"};
constexpr std::array<std::string_view, 4> kBlockingTypes{"NONE", "SINGLE", "SOFT", "HARD"};

}  // namespace

std::string parse_metadata(const JsonReader& owner) {
  const JsonReader member = owner.find("metadata");
  if (!member) return {};
  if (member.value().is_object()) return text_of_member(member, "metadata", "object");
  member.must_be(fault::kWrongType, "an object");
  return {};
}

std::string parse_goal_actions(const JsonReader& goal) {
  const JsonReader member = goal.find("actions").array();
  if (!member) return {};
  const std::size_t before = goal.fault_count();
  for (const JsonReader item : member.items()) {
    const JsonReader action = item.object(kActionMembers);
    action.require("type").name();
    action.find("blocking_type").word(kBlockingTypes);
    action.find("retriable").boolean();
    const JsonReader parameters = action.find("parameters");
    if (parameters && !parameters.value().is_object()) parameters.must_be(fault::kWrongType, "an object");
  }
  if (goal.fault_count() != before) return {};
  if (member.size() == 0) return text_of_member(member, "actions", "goal");
  const JsonReader service = goal.require("service", "; actions are executed during the service of a goal");
  if (service && service.value().number() == 0.0) {
    service.must_be(fault::kOutOfRange, "more than 0 where a goal has actions");
  }
  return text_of_member(member, "actions", "goal");
}

std::string text_of_any_of(const JsonReader& any_of) { return text_of_member(any_of, "any_of", "goal"); }

}  // namespace fleetplan::api
