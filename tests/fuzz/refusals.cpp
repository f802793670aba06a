#include "tests/fuzz/refusals.h"

#include <cstdint>
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

/// Looks for an object with two members of the same key. In time linear in the document, unlike the callback
/// of Json::parse(), which looks through all elements around an object at its end.
class RepeatedKeys : public nlohmann::json_sax<Json> {
 public:
  bool found = false;

  bool start_object(std::size_t /*size*/) override {
    keys_.emplace_back();
    return true;
  }
  bool key(std::string& name) override {
    found = !keys_.back().insert(name).second;
    return !found;
  }
  bool end_object() override {
    keys_.pop_back();
    return true;
  }
  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(std::int64_t /*value*/) override { return true; }
  bool number_unsigned(std::uint64_t /*value*/) override { return true; }
  bool number_float(double /*value*/, const std::string& /*text*/) override { return true; }
  bool string(std::string& /*value*/) override { return true; }
  bool binary(Json::binary_t& /*value*/) override { return true; }
  bool start_array(std::size_t /*size*/) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t /*place*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    return false;
  }

 private:
  std::vector<std::set<std::string>> keys_;  // of the objects around the place
};

/// The same, if the fault that says so is not listed.
bool has_repeated_key(std::string_view body) {
  RepeatedKeys keys;
  Json::sax_parse(body, &keys);
  return keys.found;
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
