// Whether the public headers have what requests and answers of the service have.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

namespace fleetplan {
namespace TEST_FILE {

using Json = nlohmann::json;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The public headers, without comments.
std::string headers() {
  std::string all;
  for (const auto& entry : std::filesystem::directory_iterator(FLEETPLAN_INCLUDE))
    all += text_of(entry.path());
  return std::regex_replace(all, std::regex("//[^\n]*"), "");
}

/// Whether a type has a member of this name.
bool has_member(const std::string& code, const std::string& name) {
  return std::regex_search(code, std::regex("\\b" + name + "( =|;|\\{)"));
}

struct Case {
  std::string schema;
  std::set<std::string>
      without;  // what the library does without, because only the wire or the service has it
};

class LibraryMembers : public testing::TestWithParam<Case> {};

TEST_P(LibraryMembers, AreThoseOfTheService) {
  static const std::string code = headers();
  const Json openapi = Json::parse(text_of(FLEETPLAN_OPENAPI));
  const Json& properties = openapi.at("components").at("schemas").at(GetParam().schema).at("properties");
  for (const auto& [name, schema] : properties.items()) {
    const bool is_without = GetParam().without.contains(name);
    EXPECT_NE(has_member(code, name), is_without)
        << name << " of " << GetParam().schema
        << (is_without ? " is in include/fleetplan now: take it off the list of this test"
                       : " is not in include/fleetplan: add it, or to the list of this test with the reason");
  }
  for (const std::string& name : GetParam().without) {
    EXPECT_TRUE(properties.contains(name)) << name << " is no member of " << GetParam().schema << " any more";
  }
}

// `metadata` is repeated as it is; margins that become an inflation, programs add as they like. The library
// has no zones that are entered only to leave them (`enter`), calls `after` of obstacles `stays`, and its
// lists are whole. It has no dependencies with a plan alone, so it cannot tell whom a wait is for.
INSTANTIATE_TEST_SUITE_P(
    Of, LibraryMembers,
    testing::Values(Case{"RobotDefaults", {"execution_margin", "stop_distance", "body_radius"}},
                    Case{"Robot", {"execution_margin", "stop_distance", "body_radius", "metadata"}},
                    Case{"PlacedGoal", {"metadata"}}, Case{"OpenGoal", {"metadata"}},
                    Case{"PlanOptions", {"time_budget_ms", "execution_margin"}},
                    Case{"BlockedZone", {"enter"}}, Case{"SpeedZone", {}}, Case{"OneWayZone", {}},
                    Case{"Obstacle", {"after"}}, Case{"Action", {"for"}},
                    Case{"RobotPlan", {"ends_at", "blocked_by_total", "metadata"}},
                    Case{"Unplanned", {"blocked_by_total", "errors", "metadata"}}, Case{"Violation", {}}),
    [](const testing::TestParamInfo<Case>& of) { return of.param.schema; });

}  // namespace TEST_FILE
}  // namespace fleetplan
