#include "api/json/json_reader.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/api/support/requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

constexpr Range kUnit{0.0, 1.0, "metres"};
constexpr std::array<std::string_view, 2> kMembers{"a", "b"};

JsonDocument document(std::string_view body) {
  auto read = read_json(body, 32, unbounded_work());
  return std::move(*read);
}

TEST(JsonReader, ReadsMembersAndItems) {
  JsonDocument read = document(R"({"a": [0.5, true, "name"], "b": 7})");
  const JsonReader root = JsonReader(read).object(kMembers);
  const JsonReader items = root.require("a").array();
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(items.item(0).number(kUnit), 0.5);
  EXPECT_EQ(items.item(1).boolean(), true);
  EXPECT_EQ(items.item(2).name(), "name");
  EXPECT_EQ(items.item(2).word(std::array<std::string_view, 2>{"word", "name"}), 1U);
  EXPECT_EQ(root.find("b").natural(9), 7U);
  EXPECT_TRUE(read.faults.empty());
}

TEST(JsonReader, ReadsAllMembersInTheirOrder) {
  JsonDocument read = document(R"({"b": 1, "a": 2, "c": [3]})");
  const JsonReader root(read);
  std::string keys;
  double sum = 0.0;
  for (const JsonReader member : root.members()) {
    keys += member.value().key();
    if (member.is_number()) sum += *member.value().number();
  }
  EXPECT_EQ(keys, "bac");
  EXPECT_EQ(sum, 3.0);
  for ([[maybe_unused]] const JsonReader member : root.find("c").members()) ADD_FAILURE();
  for ([[maybe_unused]] const JsonReader item : root.items()) ADD_FAILURE();
  for ([[maybe_unused]] const JsonReader member : root.find("d").members()) ADD_FAILURE();
}

TEST(JsonReader, ReadsNothingFromAnAbsentValueWithoutAFault) {
  JsonDocument read = document("{}");
  const JsonReader absent = JsonReader(read).find("a");
  EXPECT_FALSE(absent);
  EXPECT_FALSE(absent.object(kMembers).require("b").number(kUnit));
  EXPECT_FALSE(absent.natural(9));
  EXPECT_FALSE(absent.boolean());
  EXPECT_FALSE(absent.name());
  EXPECT_EQ(absent.array().size(), 0U);
  EXPECT_TRUE(read.faults.empty());
  for (const JsonReader& part :
       {absent, absent.object(kMembers), absent.array(), absent.find("b"), absent.require("b")}) {
    EXPECT_EQ(&part.work(), &JsonReader(read).work()) << "work for what is absent is bounded, too";
  }
}

TEST(JsonReader, ReportsFaultsAtTheirPlacesInTheOrderOfTheDocument) {
  JsonDocument read = document(R"([{"c": 1, "a": 2}, 3, null])");
  const JsonReader items = JsonReader(read).array();
  EXPECT_FALSE(items.item(2).name());
  EXPECT_FALSE(items.item(1).object(kMembers));
  const JsonReader object = items.item(0).object(kMembers);
  EXPECT_FALSE(object.require("b", "; give it"));
  EXPECT_FALSE(object.require("a").number(kUnit));
  const auto faults = read.faults.listed();
  EXPECT_EQ(brief(faults), (Faults{{"/0/c", "unknown_key"},
                                   {"/0/a", "out_of_range"},
                                   {"/0/b", "missing"},
                                   {"/1", "wrong_type"},
                                   {"/2", "wrong_type"}}));
  EXPECT_EQ(faults[0].detail, R"("c" is not a known member; did you mean "a"?)");
  EXPECT_EQ(faults[1].detail, "a must be from 0 to 1 metres, not 2.");
  EXPECT_EQ(faults[2].detail, "b is missing; give it.");
  EXPECT_EQ(faults[3].detail, "item 1 must be an object, not 3.");
  EXPECT_EQ(faults[4].detail,
            "item 2 must be a string, not null; omit it to use its default, if it has one.");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
