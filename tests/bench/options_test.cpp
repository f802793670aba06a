#include "tests/bench/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetplan::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Options options_of(std::vector<std::string> arguments) {
  return std::get<Options>(parse_options(std::move(arguments)));
}

TEST(Numbers, AreListsAndRanges) {
  EXPECT_THAT(parse_numbers("7").value(), ElementsAre(7));
  EXPECT_THAT(parse_numbers("1-3,7").value(), ElementsAre(1, 2, 3, 7));
  EXPECT_THAT(parse_numbers("15-60:15").value(), ElementsAre(15, 30, 45, 60));
  EXPECT_THAT(parse_numbers("1-10:4,2").value(), ElementsAre(1, 5, 9, 2));
}

TEST(Numbers, AreNothingElse) {
  for (const char* text : {"", ",", "1,", "a", "1-", "3-1", "1-3:0", "1-3:", "1 2", "-1", "1.5", "0-1000000"})
    EXPECT_FALSE(parse_numbers(text)) << text;
}

TEST(Options, AreAQuickRunOfBothHallsByDefault) {
  const Options options = options_of({});
  EXPECT_THAT(options.halls, ElementsAre("empty", "rects"));
  EXPECT_THAT(options.seeds, ElementsAre(1, 2, 3));
  EXPECT_THAT(options.robots, ElementsAre(60, 120, 180, 240, 300));
  EXPECT_EQ(options.planning.at("time_budget_ms"), 60'000);
}

TEST(Options, AreThePapersWholeProtocolWhenAskedFor) {
  const Options options = options_of({"--full"});
  EXPECT_EQ(options.seeds.size(), 100u);
  EXPECT_EQ(options.robots.size(), 20u);
  EXPECT_EQ(options.robots.front(), 15u);
  EXPECT_EQ(options.robots.back(), 300u);
}

TEST(Options, OfFilesTakeAllRobotsUnlessTold) {
  EXPECT_TRUE(options_of({"a.json"}).robots.empty());
  EXPECT_THAT(options_of({"--robots", "5,6", "a.json"}).robots, ElementsAre(5, 6));
}

TEST(Options, GoIntoTheRequests) {
  const Options options =
      options_of({"--budget", "2.5", "--mode", "anytime", "--options", R"({"connectivity": 4})"});
  EXPECT_EQ(options.planning,
            nlohmann::json({{"time_budget_ms", 2500}, {"mode", "anytime"}, {"connectivity", 4}}));
}

TEST(Options, NameTheFilesToWriteAfterWhatIsMeasured) {
  EXPECT_EQ(options_of({}).csv, "");
  EXPECT_EQ(options_of({"--output", "to"}).csv, "to/paper.csv");
  EXPECT_EQ(options_of({"--output", "to"}).svg, "to/paper.svg");
  EXPECT_EQ(options_of({"--output", "to", "--scaling"}).csv, "to/scaling.csv");
  EXPECT_EQ(options_of({"--output", "to", "a.json"}).csv, "to/files.csv");
  EXPECT_EQ(options_of({"--output", "to", "--reference", "r.csv", "a.json"}).csv, "to/comparison.csv");
  EXPECT_EQ(options_of({"--output", "to", "--csv", "mine.csv"}).csv, "mine.csv");
  EXPECT_EQ(options_of({"--output", "to", "--output", "there"}).csv, "there/paper.csv");
}

TEST(Options, FindTheReferencesFilesBesideItUnlessTold) {
  EXPECT_EQ(options_of({"--reference", "data/r.csv"}).root, "data");
  EXPECT_EQ(options_of({"--reference", "r.csv"}).root, ".");
  EXPECT_EQ(options_of({"--reference", "data/r.csv", "--root", "x"}).root, "x");
}

TEST(Options, ThatMakeNoSenseAreRefusedByName) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes = {
      {{"--seeds", "x"}, "--seeds"},     {{"--robots", "0"}, "--robots"}, {{"--options", "[1]"}, "--options"},
      {{"--halls", "round"}, "--halls"}, {{"--budget", "0"}, "--budget"}, {{"--bogus"}, "--bogus"}};
  for (const auto& [arguments, name] : mistakes) {
    const auto parsed = parse_options(arguments);
    const auto* exit = std::get_if<Exit>(&parsed);
    ASSERT_NE(exit, nullptr) << name;
    EXPECT_EQ(exit->code, 2);
    EXPECT_THAT(exit->text, HasSubstr(name));
  }
}

TEST(Options, HelpIsNoMistake) {
  const auto parsed = parse_options({"--help"});
  ASSERT_TRUE(std::holds_alternative<Exit>(parsed));
  EXPECT_EQ(std::get<Exit>(parsed).code, 0);
  EXPECT_THAT(std::get<Exit>(parsed).text, HasSubstr("--reference"));
}

}  // namespace
}  // namespace fleetplan::bench
