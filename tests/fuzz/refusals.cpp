#include "tests/fuzz/refusals.h"

#include <nlohmann/json.hpp>
#include <string>

#include "tests/fuzz/require.h"

namespace fleetplan::fuzz {

namespace {

using Json = nlohmann::json;

void require_existing_member(const Json& document, const Json& fault, const std::string& reply) {
  Json::json_pointer pointer(fault.at("pointer").get<std::string>());
  if (fault.at("code") == "missing") pointer.pop_back();
  require(document.contains(pointer), "the pointer of a fault does not exist", reply);
}

/// Of two members with the same key, nlohmann's parser keeps the last and the service the first. The fault
/// that says so may be one of those that are not listed.
bool may_have_duplicate(const Json& problem) {
  const Json& faults = problem.at("errors");
  for (const Json& fault : faults) {
    if (fault.at("code") == "duplicate") return true;
  }
  return problem.at("errors_total") > faults.size();
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
  if (document.is_discarded() || may_have_duplicate(problem)) return;
  for (const Json& fault : faults) require_existing_member(document, fault, reply.body);
}

}  // namespace fleetplan::fuzz
