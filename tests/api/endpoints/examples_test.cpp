#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "api/endpoints/endpoints.h"
#include "api/request/parse_request.h"
#include "tests/api/support/requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

TEST(Examples, AreValidRequestsSortedByName) {
  ASSERT_FALSE(examples().empty());
  for (const Example& example : examples()) {
    EXPECT_TRUE(parse_request(example.body, {}, unbounded_work())) << example.name;
  }
  EXPECT_TRUE(std::is_sorted(examples().begin(), examples().end(),
                             [](const Example& a, const Example& b) { return a.name < b.name; }));
}

TEST(Examples, AreListedWithTheirTitlesAndSizes) {
  const Reply reply = examples_endpoint();
  EXPECT_EQ(reply.status, 200);
  const Json list = json_of(reply)["examples"];
  std::set<std::string> names;
  for (const auto& entry : list) {
    const std::string name = entry["name"];
    names.insert(name);
    EXPECT_FALSE(entry["title"].get<std::string>().empty()) << name;
    EXPECT_FALSE(entry["description"].get<std::string>().empty()) << name << " is not in index.json";
    const auto example = std::find_if(examples().begin(), examples().end(),
                                      [&](const Example& one) { return one.name == name; });
    ASSERT_NE(example, examples().end());
    const Json request = Json::parse(example->body);
    EXPECT_EQ(entry["robots"], request["robots"].size());
    const Json& map = request["map"];
    if (!map.contains("rows")) continue;
    EXPECT_EQ(entry["rows"], map["rows"].size());
    EXPECT_EQ(entry["columns"], map["rows"][0].get<std::string>().size());
  }
  EXPECT_EQ(names.size(), examples().size());
}

TEST(Examples, AreListedWithTheSizesOfTheirImages) {
  std::map<std::string, std::pair<int, int>> sizes;
  const Json list = json_of(examples_endpoint())["examples"];
  for (const auto& entry : list) sizes[entry["name"]] = {entry["columns"], entry["rows"]};
  EXPECT_EQ(sizes["office-floor"], std::pair(1200, 800));
  EXPECT_EQ(sizes["hospital-wing"], std::pair(1200, 560));
}

TEST(Examples, BeginWithTheFirstEntryOfTheIndex) {
  EXPECT_EQ(json_of(examples_endpoint())["examples"][0]["name"], "corridor-swap");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
