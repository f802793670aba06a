#include "tests/fuzz/refusals.h"

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/require.h"

namespace fleetplan::fuzz {

namespace {

using Json = nlohmann::json;

void require_existing_member(const Json& document, const Json& fault, const std::string& reply) {
  Json::json_pointer pointer(fault.at("pointer").get<std::string>());
  if (fault.at("code") == "missing") pointer.pop_back();
  require(document.contains(pointer), "the pointer of a fault does not exist", reply);
}

/// Of two members with the same key, nlohmann's parser keeps the last and the service the first.
bool has_duplicate(const Json& faults) {
  for (const Json& fault : faults) {
    if (fault.at("code") == "duplicate") return true;
  }
  return false;
}

/// The same, if the fault that says so is one of those that are not listed.
bool has_repeated_key(std::string_view body) {
  std::vector<std::set<std::string>> keys;  // of the objects around the place
  bool found = false;
  const auto look = [&](int /*depth*/, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key)
      found = !keys.back().insert(value.get<std::string>()).second || found;
    return true;
  };
  return !Json::parse(body, look, false).is_discarded() && found;
}

}  // namespace

void require_proper_refusal(std::string_view body, const api::Reply& reply) {
  require(reply.content_type == api::kProblemJson, "a rejection is not a problem document",
          reply.content_type);
  const Json problem = Json::parse(reply.body, nullptr, false);
  require(problem.is_object(), "a rejection is not JSON", reply.body);
  require(problem.at("status") == reply.status, "a rejection has two statuses", reply.body);
  require(!problem.at("detail").get<std::string>().empty(), "a rejection has no detail", reply.body);
  if (reply.status == 400) return;
  require(reply.status == 422, "a rejection has a status other than 400 and 422", reply.body);
  const Json& faults = problem.at("errors");
  const std::string code = problem.at("code");
  const bool spent = code == "check_unfinished" || code == "parse_unfinished" || code == "memory_exceeded";
  require(faults.empty() == spent, "faults are missing, or present although a budget was spent", reply.body);
  const Json document = Json::parse(body, nullptr, false);  // discarded where a number is too large for it
  if (document.is_discarded() || has_duplicate(faults) || has_repeated_key(body)) return;
  for (const Json& fault : faults) require_existing_member(document, fault, reply.body);
}

}  // namespace fleetplan::fuzz
