#include "tests/fuzz/refusals.h"

#include <nlohmann/json.hpp>
#include <string>

#include "tests/fuzz/require.h"

namespace fleetplan::fuzz {

namespace {

using Json = nlohmann::json;

void require_a_place(const Json& document, const Json& fault, const std::string& reply) {
  Json::json_pointer pointer(fault.at("pointer").get<std::string>());
  if (fault.at("code") == "missing") pointer.pop_back();
  require(document.contains(pointer), "a fault points nowhere", reply);
}

/// The library's own reading of a document keeps the last of two members with the same key, the service the
/// first.
bool has_a_duplicate(const Json& faults) {
  for (const Json& fault : faults) {
    if (fault.at("code") == "duplicate") return true;
  }
  return false;
}

}  // namespace

void require_proper_refusal(std::string_view body, const api::Reply& reply) {
  require(reply.content_type == api::kProblemJson, "a refusal is no problem", reply.content_type);
  const Json problem = Json::parse(reply.body, nullptr, false);
  require(problem.is_object(), "a refusal is not JSON", reply.body);
  require(problem.at("status") == reply.status, "a refusal has two statuses", reply.body);
  require(!problem.at("detail").get<std::string>().empty(), "a refusal does not say why", reply.body);
  if (reply.status == 400) return;
  require(reply.status == 422, "a refusal does not blame the request", reply.body);
  const Json& faults = problem.at("errors");
  const bool late = problem.at("code") == "check_unfinished";
  require(faults.empty() == late, "a refusal names no fault, or one where time is to blame", reply.body);
  const Json document = Json::parse(body, nullptr, false);  // discarded where a number is too large for it
  if (document.is_discarded() || has_a_duplicate(faults)) return;
  for (const Json& fault : faults) require_a_place(document, fault, reply.body);
}

}  // namespace fleetplan::fuzz
