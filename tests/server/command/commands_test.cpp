
#include "server/command/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "api/json/printable.h"
#include "core/runtime/random.h"
#include "server/service/service.h"
#include "tests/server/support/environment.h"
#include "tests/support/temporary_file.h"
#include "tests/support/temporary_folder.h"

namespace fleetplan::server {
namespace TEST_FILE {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// What a command did.
struct Outcome {
  std::optional<int> code;
  std::string out;
  std::string err;
};

Outcome run(std::vector<std::string> arguments, const std::string& input = "", bool on_terminal = false) {
  std::istringstream in(input);
  std::ostringstream out, err;
  const auto code = run_command(std::move(arguments), planning_service, {in, out, err, on_terminal});
  return {code, out.str(), err.str()};
}

std::string content(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Two robots in a corridor, which move from x = 0.5 to 2.5 and from 4.5 to 6.5.
std::string request(const std::string& row, double start_of_a = 0.5) {
  const auto robot = [](const char* id, double from, double to) {
    return Json{{"id", id}, {"start", {{"x", from}, {"y", 0.5}}}, {"goal", {{"x", to}, {"y", 0.5}}}};
  };
  return Json{{"map", {{"rows", {row}}}},
              {"robots", {robot("a", start_of_a, 2.5), robot("b", 4.5, 6.5)}},
              {"robot_defaults", {{"radius", 0.3}, {"linear_speed", 1.0}, {"angular_speed", 1.0}}}}
      .dump();
}

TEST(Commands, LeaveTheSettingsOfTheServerAlone) {
  EXPECT_FALSE(run({}).code);
  EXPECT_FALSE(run({"--port", "0"}).code);
  EXPECT_FALSE(run({"--help"}).code);
  EXPECT_FALSE(run({"serve", "--port", "0"}).code);
}

TEST(Commands, AnswerAsTheServiceDoes) {
  const Outcome outcome = run({"plan"}, request("......."));
  EXPECT_EQ(outcome.code, kSolved);
  EXPECT_EQ(outcome.err, "");
  const Json answer = Json::parse(outcome.out);
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(answer["verified"], true);
  EXPECT_EQ(answer["plans"].size(), 2u);
}

TEST(Commands, TellInTheExitCodeHowManyRobotsHaveAPlan) {
  EXPECT_EQ(run({"plan"}, request(".....#.")).code, kPartial);
  EXPECT_EQ(run({"plan"}, request(".#...#.")).code, kNone);
}

TEST(Commands, TellInTheExitCodeWhetherPlansAreValid) {
  Json body = Json::parse(request("......."));
  const Json plans = Json::parse(run({"plan"}, body.dump()).out)["plans"];
  body["plans"] = plans;
  EXPECT_EQ(run({"validate"}, body.dump()).code, kSolved);
  body["plans"][0]["actions"][0]["t_end"] = 0.01;
  EXPECT_EQ(run({"validate"}, body.dump()).code, kPartial);
}

TEST(Commands, ListFaultsAsLines) {
  const support::TemporaryFile file(request(".......", 0.1));
  const Outcome outcome = run({"plan", file.path()});
  EXPECT_EQ(outcome.code, kBadInput);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, AllOf(StartsWith(file.path() + ": /robots/0/start: "), HasSubstr("move it")));
  EXPECT_THAT(run({"plan"}, "{").err, StartsWith("stdin: Not JSON"));
}

TEST(Commands, RejectWhatTheyDoNotKnow) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"plam"},
                                                    {"plan", "--fast"},
                                                    {"validate", "--svg", "x"},
                                                    {"examples", "none"},
                                                    {"plan", "/no/such/file"},
                                                    {"plan", "/"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, kBadInput) << arguments[0];
    EXPECT_NE(outcome.err, "") << arguments[0];
  }
}

TEST(Commands, WriteAnswerAndPictureToFiles) {
  const support::TemporaryFolder folder;
  const std::string answer = folder.path() / "answer.json", picture = folder.path() / "picture.svg";
  const Outcome outcome = run({"plan", "-", "--output", answer, "--svg", picture}, request("......."));
  EXPECT_EQ(outcome.code, kSolved);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(Json::parse(content(answer))["status"], "solved");
  EXPECT_THAT(content(picture),
              AllOf(StartsWith("<svg "), HasSubstr("<title>b</title>"), HasSubstr("</svg>")));
  const std::string painted = folder.path() / "picture.png";
  EXPECT_EQ(run({"plan", "--png", painted}, request(".....#.")).code, kPartial);
  EXPECT_THAT(content(painted), StartsWith("\x89PNG"));
  EXPECT_EQ(run({"plan", "--png", "/no/such/folder/x"}, request(".......")).code, kFailed);
  EXPECT_EQ(run({"plan", "--output", "/no/such/folder/x"}, request(".......")).code, kFailed);
}

TEST(Commands, DrawAPlanWithoutMotionToo) {
  const support::TemporaryFolder folder;
  const std::string picture = folder.path() / "picture.svg";
  Json spent = Json::parse(request("......."));
  spent["options"]["time_budget_ms"] = 1;  // spent, as a rule, before planning begins
  run({"plan", "--svg", picture}, spent.dump());
  EXPECT_THAT(content(picture), HasSubstr("<title>b"));
}

/// What a terminal must not get, with a line feed, which must not begin a line of its own.
const std::string kHostile = "\x1b]0;t\a\x1b[31m\u009b2J\u202e\u2066\x7f\nforged: line";

TEST(Commands, ShowNoControlCharactersOfTheirInput) {
  const support::TemporaryFolder folder;
  const auto file = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
    return (folder.path() / name).string();
  };
  const auto with = [](const auto& change) {
    Json body = Json::parse(request("......."));
    change(body);
    return body.dump();
  };
  const std::string robots = file("r.csv", "id,radius\n");
  const std::string in_yaml = R"(\e[31m\x9b\u202e)";
  struct Case {
    std::vector<std::string> arguments;
    std::string input;
  };
  const std::vector<Case> cases{
      {{"plan"}, with([](Json& body) { body["robots"][1]["id"] = body["robots"][0]["id"] = kHostile; })},
      {{"plan"}, with([](Json& body) { body["options"]["mode"] = kHostile; })},
      {{"plan"}, with([](Json& body) { body[kHostile] = 1; })},
      {{"plan"}, with([](Json& body) { body["robots"][0][kHostile] = 1; })},
      {{"plan"}, with([](Json& body) { body["robots"][0]["id"] = kHostile; })},
      {{"plan"}, kHostile},
      {{"plan", kHostile}, ""},
      {{"plan", "-", "--" + kHostile}, ""},
      {{"plan", "-", "--max-robots", kHostile}, ""},
      {{"plan", "-", "-o", folder.path() / "none" / kHostile}, request(".......")},
      {{"plan", "-", "--svg", folder.path() / "none" / kHostile}, request(".......")},
      {{kHostile}, ""},
      {{"examples", kHostile}, ""},
      {{"map2request", kHostile, "--robots", robots}, ""},
      {{"map2request", file("k.yaml", "\"x" + in_yaml + "\": 1\n"), "--robots", robots}, ""},
      {{"map2request", file("i.yaml", "image: \"" + in_yaml + "\"\n"), "--robots", robots}, ""},
      {{"map2request", file("m.yaml", "image: a\nmode: \"" + in_yaml + "\"\n"), "--robots", robots}, ""},
      {{"map2request", file("y.yaml", kHostile + ": [\n"), "--robots", robots}, ""},
  };
  for (const Case& one : cases) {
    const Outcome outcome = run(one.arguments, one.input);
    for (const std::string& text : {outcome.out, outcome.err}) {
      EXPECT_EQ(text, api::printable(text, api::Lines::kept)) << testing::PrintToString(one.arguments);
    }
    EXPECT_FALSE(outcome.err.starts_with("forged")) << outcome.err;
  }
}

TEST(Commands, ShowIdsOfTheAnswerAsJson) {
  Json body = Json::parse(request("......."));
  body["robots"][0]["id"] = kHostile;
  EXPECT_EQ(Json::parse(run({"plan"}, body.dump()).out)["plans"][0]["robot"], kHostile);
}

/// Returns the texts of all titles, without entities.
std::string titles_without_entities(std::string picture) {
  std::string texts;
  for (std::size_t at = 0; (at = picture.find("<title>", at)) != std::string::npos;) {
    const std::size_t end = picture.find("</title>", at);
    texts += picture.substr(at + 7, end - at - 7);
    at = end;
  }
  for (const std::string entity : {"&amp;", "&lt;"}) {
    for (std::size_t at = 0; (at = texts.find(entity)) != std::string::npos;) texts.erase(at, entity.size());
  }
  return texts;
}

TEST(Commands, DrawIdsOfAnyCharactersAsXml) {
  core::Random random(3);
  const support::TemporaryFolder folder;
  const std::string svg = folder.path() / "plan.svg";
  for (int round = 0; round < 200; ++round) {
    std::string id = "</title><script>&\"'";
    for (int k = 0; k < 8; ++k) {
      const std::string characters = "\x01\x1b\x7f\u0085\u202e\uffff\ufffe\U0001ffff<&]>\nä車";
      std::size_t at = random.below(characters.size());
      while (at > 0 && (static_cast<unsigned char>(characters[at]) & 0xC0U) == 0x80U) --at;
      std::size_t end = at + 1;
      while (end < characters.size() && (static_cast<unsigned char>(characters[end]) & 0xC0U) == 0x80U) ++end;
      id.insert(0, characters.substr(at, end - at));
    }
    Json body = Json::parse(request("......."));
    body["robots"][0]["id"] = id;
    ASSERT_EQ(run({"plan", "-", "--svg", svg}, body.dump()).code, kSolved);
    const std::string picture = content(svg);
    EXPECT_EQ(picture, api::printable(picture, api::Lines::kept));
    EXPECT_EQ(titles_without_entities(picture).find_first_of("<&"), std::string::npos) << picture;
  }
}

TEST(Commands, MakeTheServiceOnlyToUseIt) {
  const auto no_service = []() -> Service { throw std::logic_error("the service is not needed"); };
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"--healthcheck"}, {"help"}, {"plan", "--help"}, {"plam"}, {"serve"}}) {
    std::istringstream in;
    std::ostringstream out, err;
    EXPECT_NO_THROW(run_command(arguments, no_service, {in, out, err, false}));
  }
}

TEST(Commands, ShowProgressOnATerminalOnly) {
  EXPECT_THAT(run({"plan"}, request("......."), true).err, HasSubstr("robots planned"));
  EXPECT_EQ(run({"plan", "--quiet"}, request("......."), true).err, "");
}

TEST(Commands, PrintTheExamplesThatThePageOffers) {
  const Outcome list = run({"examples"});
  EXPECT_EQ(list.code, kSolved);
  EXPECT_THAT(list.out, HasSubstr("warehouse\n"));
  EXPECT_EQ(run({"plan"}, run({"examples", "corridor-swap"}).out).code, kSolved);
}

TEST(Commands, TakeTheLimitsOfTheServiceFromFlagsAndTheEnvironment) {
  EXPECT_THAT(run({"plan", "--max-robots", "1"}, request(".......")).err, HasSubstr("/robots"));
  const Environment robots("FLEETPLAN_MAX_ROBOTS", "1");
  EXPECT_EQ(run({"plan"}, request(".......")).code, kBadInput);
  EXPECT_EQ(run({"plan", "--max-robots=2", "--workers=3"}, request(".......")).code, kSolved);
  Json improved = Json::parse(request("......."));
  improved["options"] = {{"mode", "anytime"}, {"time_budget_ms", 1000}, {"max_iterations", 1}};
  const auto warnings = [&](const char* max) {
    const auto outcome = run({"plan", "--max-robots=2", "--max-budget-ms", max}, improved.dump());
    return Json::parse(outcome.out)["warnings"].size();
  };
  EXPECT_EQ(warnings("999"), warnings("1000") + 1);  // that the budget was clamped
}

TEST(Commands, RejectLimitsThatTheServiceRejects) {
  EXPECT_THAT(run({"plan", "--max-plan-memory=1KiB"}, request(".......")).err, HasSubstr("1 MiB to 1 TiB"));
  EXPECT_EQ(run({"plan", "--max-plan-memory=1KiB"}, request(".......")).code, kBadInput);
  EXPECT_EQ(run({"plan", "--default-budget-ms=200000"}, request(".......")).code, kBadInput);
  EXPECT_EQ(run({"matrix", "--workers=0"}).code, kBadInput);
  const Environment workers("FLEETPLAN_WORKERS", "many");
  const Outcome outcome = run({"plan"}, request("......."));
  EXPECT_EQ(outcome.code, kBadInput);
  EXPECT_THAT(outcome.err, HasSubstr("--workers"));
}

TEST(Commands, ExplainThemselves) {
  const Outcome help = run({"help"});
  EXPECT_EQ(help.code, kSolved);
  EXPECT_THAT(help.out, AllOf(HasSubstr("validate"), HasSubstr("Exit codes")));
  EXPECT_EQ(run({"plan", "--help"}).code, kSolved);
  EXPECT_THAT(run({"plan", "--help"}).out, HasSubstr("--max-plan-memory"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
