#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "server/command/commands.h"
#include "server/service/service.h"
#include "tests/support/temporary_folder.h"

namespace fleetplan::server {
namespace TEST_FILE {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// A free map of 8 x 5 m with a wall in the column of pixels 8 of 16.
constexpr const char* kImage =
    "P2\n# a comment\n16 10\n255\n"
    "254 254 254 254 254 254 254 254 0 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 0 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 0 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 0 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 254 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 254 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 254 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 254 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 254 254 254 254 254 254 254 254\n"
    "254 254 254 254 254 254 254 254 254 254 254 254 254 254 254 254\n";
constexpr const char* kYaml =
    "image: map.pgm\nmode: trinary\nresolution: 0.5\norigin: [-2.0, -1.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
constexpr const char* kHeader =
    "name,radius,speed,angular_speed,start_x,start_y,start_theta,goal_x,goal_y,goal_theta\n";
constexpr const char* kRobots =
    "name,radius,speed,angular_speed,start_x,start_y,start_theta,goal_x,goal_y,goal_theta\n"
    "amr-1,0.25,1.0,2.0,-1.0,0.0,,5.0,2.0,1.57\n"
    "\"parked, for now\",0.3,1,2,0,2,0,,,\n";

struct Outcome {
  std::optional<int> code;
  std::string out;
  std::string err;
};

/// Files of a conversion, and what it makes of them.
class Map2Request : public testing::Test {
 protected:
  Map2Request() { write("map.pgm", kImage); }

  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }

  std::string path(const std::string& name) const { return folder_.path() / name; }

  Outcome run(const std::string& yaml, const std::string& robots) {
    write("map.yaml", yaml);
    write("robots.csv", robots);
    return command({"map2request", path("map.yaml"), "--robots", path("robots.csv")});
  }

  static Outcome command(std::vector<std::string> arguments, const std::string& input = "") {
    std::istringstream in(input);
    std::ostringstream out, err;
    const auto code = run_command(std::move(arguments), planning_service, {in, out, err, false});
    return {code, out.str(), err.str()};
  }

  /// Expects one line that begins with the file and the line, and has these words.
  void expect_refused(const Outcome& outcome, const std::string& place, const std::string& words) {
    EXPECT_EQ(outcome.code, kBadInput);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, AllOf(StartsWith(path(place) + ": "), HasSubstr(words)));
  }

 private:
  support::TemporaryFolder folder_;
};

TEST_F(Map2Request, MakesARequestThatIsPlanned) {
  const Outcome made = run(kYaml, kRobots);
  EXPECT_EQ(made.code, kSolved);
  EXPECT_EQ(made.err, "");
  const Json request = Json::parse(made.out);
  EXPECT_EQ(request["map"]["image"]["origin"], Json::parse("[-2.0, -1.0, 0.0]"));
  EXPECT_EQ(request["map"]["image"]["resolution"], 0.5);
  const Json expected = Json::parse(R"([
      {"id": "amr-1", "radius": 0.25, "linear_speed": 1, "angular_speed": 2, "start": {"x": -1, "y": 0},
       "goal": {"x": 5, "y": 2, "theta": 1.57}},
      {"id": "parked, for now", "radius": 0.3, "linear_speed": 1, "angular_speed": 2,
       "start": {"x": 0, "y": 2, "theta": 0}}])");
  EXPECT_EQ(request["robots"], expected);
  EXPECT_EQ(command({"plan"}, made.out).code, kSolved);
}

TEST_F(Map2Request, HasTheLimitsOfARequest) {
  run(kYaml, kRobots);
  const auto limited = [&](const std::string& flag) {
    return command({"map2request", path("map.yaml"), "--robots", path("robots.csv"), flag});
  };
  EXPECT_EQ(limited("--max-robots=2").code, kSolved);
  EXPECT_EQ(limited("--max-robots=1").code, kBadInput);
  EXPECT_THAT(limited("--max-robots=1").err, HasSubstr("at most 1"));
}

TEST_F(Map2Request, ReadsWhatMapServerReads) {
  const std::string expected = run(kYaml, kRobots).out;
  for (const std::string yaml : {
           "%YAML 1.2\n---\n# a map\nimage: \"map.pgm\"   # beside this file\nmode: 'trinary'\nresolution: "
           "\"0.5\"\n"
           "origin:\n  - -2.0\n  - -1.0  # metres\n  - 0\nnegate: false\noccupied_thresh: .65\nfree_thresh: "
           "1.96e-1\n...\n",
           "{image: map.pgm, mode: trinary, resolution: +0.50, origin: [-2, -1, 0], negate: no,\n"
           " occupied_thresh: 0.65, free_thresh: 0.196}\n",
           "image: map.pgm\r\nmode: trinary\r\nresolution: 0.5\r\norigin:\r\n- -2.\r\n- -1.\r\n- "
           "0.\r\nnegate: 0\r\n"
           "occupied_thresh: 0.65\r\nfree_thresh: 0.196\r\n",
       }) {
    const Outcome outcome = run(yaml, kRobots);
    EXPECT_EQ(outcome.code, kSolved) << outcome.err;
    EXPECT_EQ(outcome.out, expected) << yaml;
  }
  EXPECT_THAT(run("negate: 1\nimage: map.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n", kHeader).err,
              HasSubstr("at least one robot"));
}

TEST_F(Map2Request, TakesTheImageFromItsPath) {
  write("map.yaml", "image: " + path("map.pgm") + "\nresolution: 0.5\norigin: [-2, -1, 0]\n");
  write("robots.csv", kRobots);
  const std::string output = path("request.json");
  EXPECT_EQ(command({"map2request", path("map.yaml"), "--robots", path("robots.csv"), "-o", output}).code,
            kSolved);
  std::ifstream written(output);
  EXPECT_TRUE(Json::parse(written)["map"]["image"].contains("pgm"));
}

TEST_F(Map2Request, TellsWhatIsIgnored) {
  const Outcome outcome = run(std::string(kYaml) + "free_tresh: 0.25\n", kRobots);
  EXPECT_EQ(outcome.code, kSolved);
  EXPECT_THAT(outcome.err,
              AllOf(StartsWith(path("map.yaml") + ":8: "), HasSubstr("\"free_tresh\" is ignored"),
                    HasSubstr("did you mean \"free_thresh\"?")));
}

TEST_F(Map2Request, NamesFileLineAndRemedyOfAFaultInTheYaml) {
  const auto with = [](const std::string& line, const std::string& other) {
    std::string yaml = kYaml;
    return yaml.replace(yaml.find(line), line.size(), other);
  };
  const auto refused = [&](const std::string& yaml, const std::string& place, const std::string& words) {
    expect_refused(run(yaml, kRobots), place, words);
  };
  refused("", "map.yaml:1", "lines such as \"image: map.pgm\"");
  refused("- a\n- b\n", "map.yaml:1", "this is a list");
  refused("image: [map.pgm\n", "map.yaml:2", "not YAML");
  refused("\timage: map.pgm\n", "map.yaml:1", "not YAML");
  refused("P5\n1 1\n255\nx", "map.yaml", "the file that names the image");
  refused(with("resolution: 0.5", "# none"), "map.yaml", "resolution is missing; add a line such as");
  refused(with("resolution: 0.5", "resolution: 0,5"), "map.yaml:3", "must be a number, not \"0,5\"");
  refused(with("resolution: 0.5", "resolution: .nan"), "map.yaml:3", "must be a number");
  refused(with("resolution: 0.5", "resolution: 0"), "map.yaml:3", "from 1e-04 to 1e+06 metres");
  refused(with("resolution: 0.5", "mode: raw"), "map.yaml:3", "a second time");
  refused(with("[-2.0, -1.0, 0.0]", "\"\""), "map.yaml:4", "three numbers, [x, y, yaw]");
  refused(with("[-2.0, -1.0, 0.0]", "[-2.0, -1.0]"), "map.yaml:4", "it has 2");
  refused(with("[-2.0, -1.0, 0.0]", "[-2.0, -1.0, 1.57]"), "map.yaml:4", "must be a multiple of pi / 2");
  refused(with("negate: 0", "negate: 2"), "map.yaml:5", "0, 1, false or true");
  refused(with("trinary", "trinery"), "map.yaml:2", "mode must be \"trinary\", \"scale\" or \"raw\"");
  refused(with("0.65", "65"), "map.yaml:6", "from 0 to 1");
  refused(with("map.pgm", "none.pgm"), "map.yaml:1", "does it exist?");
  refused(with("map.pgm", "map.yaml"), "map.yaml:1", "neither a PGM");
  refused(with("map.pgm", "."), "map.yaml:1", "is it a folder?");
}

TEST_F(Map2Request, NamesTheImageThatIsDamaged) {
  write("map.pgm", "P5\n16 10\n255\nshort");
  expect_refused(run(kYaml, kRobots), "map.pgm", "cannot be read");
}

TEST_F(Map2Request, NamesFileLineAndColumnOfAFaultInTheTable) {
  const auto refused = [&](const std::string& robots, const std::string& place, const std::string& words) {
    expect_refused(run(kYaml, robots), place, words);
  };
  const std::string header = kHeader;
  refused("", "robots.csv", "no header line");
  refused("amr-1,0.25,1.0\n", "robots.csv:1", "unknown column \"amr-1\"");
  refused("name,radious\n", "robots.csv:1", "did you mean \"radius\"?");
  refused("id,name\n", "robots.csv:1", "is there twice");
  refused("name,radius,speed,angular_speed,start_x\n", "robots.csv:1", "column start_y is missing");
  refused(header, "robots.csv", "at least one robot");
  refused(header + "# moved\na,0.25,1,2,-1,0,0,5\n", "robots.csv:3", "8 fields, but the header has 10");
  refused(header + "a,0.25,1,2,-1,0,0,5,2,0\n\nb,0.25,fast,2,0,2,0,,,\n", "robots.csv:4",
          "linear_speed must be a number, not \"fast\"");
  refused(header + "a,0.25,1,2,,0,0,5,2,0\n", "robots.csv:2", "start_x is empty");
  refused(header + "a,0.25,1,2,-1,0,0,5,,\n", "robots.csv:2", "goal_y: y is missing");
  refused(header + "a,0.25,0,2,-1,0,0,5,2,\n", "robots.csv:2", "linear_speed: ");
  refused(header + "a,0.25,1,2,2.2,3.5,0,5,2,\n", "robots.csv:2",
          "start: The start of robot \"a\" does not fit");
  refused(header + "a,0.25,1,2,-1,0,0,5,2,\na,0.25,1,2,0,2,0,,,\n", "robots.csv:3", "\"a\"");
  refused(header + "\"a,0.25,1,2,-1,0,0,5,2,\n", "robots.csv:2", "quote is not closed");
  refused(header + "a\xff,0.25,1,2,-1,0,0,5,2,\n", "robots.csv:2", "UTF-8");
  refused("id;radius;linear_speed;angular_speed;start_x;start_y\na;0,25;1;2;-1;0\n", "robots.csv:2",
          "write a point instead of the comma");
}

TEST_F(Map2Request, ReadsTablesOfSpreadsheets) {
  const auto made = [&](const std::string& robots) { return Json::parse(run(kYaml, robots).out)["robots"]; };
  const Json expected = made("id,radius,linear_speed,angular_speed,start_x,start_y\na,0.25,1,2,-1,0\n");
  EXPECT_EQ(
      made("\xEF\xBB\xBFid;radius;linear_speed;angular_speed;start_x;start_y\r\n\"a\"; 0.25;1;2;-1;0\r\n"),
      expected);
  EXPECT_EQ(made("start_y\tid\tradius\tspeed\tangular_speed\tstart_x\n0\ta\t.25\t1\t2\t-1"), expected);
  EXPECT_EQ(made("id,radius,speed,angular_speed,start_x,start_y\n\"a \"\"b\"\"\",0.25,1,2,-1,0\n")[0]["id"],
            "a \"b\"");
}

TEST_F(Map2Request, IsBoundedForHostileFiles) {
  std::ostringstream bomb;
  bomb << "a: &a [x, x]\n";
  for (char name = 'b'; name < 'z'; ++name) {
    const char last = static_cast<char>(name - 1);
    bomb << name << ": &" << name << " [*" << last << ", *" << last << ", *" << last << "]\n";
  }
  expect_refused(run(bomb.str(), kRobots), "map.yaml", "image is missing");
  expect_refused(run(std::string(60'000, '['), kRobots), "map.yaml:1", "not YAML");
  expect_refused(run(std::string(100'000, '#'), kRobots), "map.yaml", "more than 65536 bytes");
  expect_refused(run("&a [*a]: *a\n", kRobots), "map.yaml", "image is missing");
  write("map.pgm", "P5\n" + std::string(std::size_t{26} << 20, ' '));
  expect_refused(run(kYaml, kRobots), "map.yaml:1", "Convert it to PNG");
  EXPECT_EQ(command({"map2request", path("map.yaml")}).code, kBadInput);
}

/// A free map of 6 x 4 cells but for a wall, and entries of it.
constexpr const char* kMovingAiMap = "type octile\nheight 4\nwidth 6\nmap\n......\n..@...\nG.TS..\n......\n";
constexpr const char* kScenario =
    "version 1\n"
    "0\tmy map.map\t6\t4\t0\t0\t5\t0\t5\n"    // along the top row
    "0\tmy map.map\t6\t4\t2\t1\t5\t3\t5.5\n"  // starts in a wall
    "\n"
    "3\tmy map.map\t6\t4\t0\t0\t5\t2\t5.8\r\n"   // starts where the first one does
    "3\tmy map.map\t6\t4\t5\t3\t0\t3\t5.0\r\n";  // along the bottom row

class MovingAi : public Map2Request {
 protected:
  MovingAi() { write("my map.map", kMovingAiMap); }

  Outcome convert(const std::string& scenario, const std::vector<std::string>& flags = {}) {
    write("one.scen", scenario);
    std::vector<std::string> all{"map2request", path("my map.map"), "--scenario", path("one.scen")};
    all.insert(all.end(), flags.begin(), flags.end());
    return command(all);
  }
};

TEST_F(MovingAi, MakesARequestOfTheEntriesThatArePossible) {
  const Outcome made = convert(kScenario);
  EXPECT_EQ(made.code, kSolved);
  EXPECT_THAT(made.err,
              AllOf(HasSubstr("1 entries were skipped because a disk of this radius touches a wall, 1 "),
                    HasSubstr("only 2 robots")));
  const Json expected = Json::parse(R"({
      "map": {"movingai": "type octile\nheight 4\nwidth 6\nmap\n......\n..@...\nG.TS..\n......\n"},
      "robot_defaults": {"radius": 0.4, "linear_speed": 1, "angular_speed": 3.14},
      "robots": [{"id": "r1", "start": {"x": 0.5, "y": 3.5}, "goal": {"x": 5.5, "y": 3.5}},
                 {"id": "r2", "start": {"x": 5.5, "y": 0.5}, "goal": {"x": 0.5, "y": 0.5}}]})");
  EXPECT_EQ(Json::parse(made.out), expected);
  EXPECT_EQ(command({"plan"}, made.out).code, kSolved);
}

TEST_F(MovingAi, HasAsManyRobotsOfThisKindAsAreWanted) {
  const Outcome made = convert(
      kScenario, {"--count", "1", "--radius", "0.3", "--linear-speed", "2", "--angular-speed", "0.5"});
  EXPECT_EQ(made.code, kSolved);
  EXPECT_EQ(made.err, "");
  const Json request = Json::parse(made.out);
  EXPECT_EQ(request["robots"].size(), 1);
  EXPECT_EQ(request["robot_defaults"],
            Json::parse(R"({"radius": 0.3, "linear_speed": 2, "angular_speed": 0.5})"));
  EXPECT_EQ(convert(kScenario, {"--max-robots=1"}).code, kBadInput);
  // A disk that is wider than its cell does not fit beside the edge.
  const Outcome wide = convert(kScenario, {"--radius", "0.6"});
  EXPECT_EQ(wide.code, kBadInput);
  EXPECT_THAT(wide.err, HasSubstr("no entry can be used: 4 entries were skipped"));
}

TEST_F(MovingAi, RefusesOtherFilesWithTheirPlace) {
  expect_refused(convert("version 1\n0 my map.map 6 4 0 0 5 5\n"), "one.scen:2",
                 "bucket, map, width, height");
  expect_refused(convert("0\tm\t6\t4\t0\t0\t5\t-1\t5\n"), "one.scen:1", "bucket, map, width, height");
  expect_refused(convert("0\tm\t6\t5\t0\t0\t5\t0\t5\n"), "one.scen:1", "6 x 5 cells, but the map has 6 x 4");
  expect_refused(convert("\n0\tm\t6\t4\t0\t4\t5\t0\t5\n"), "one.scen:2", "column 0, row 4");
  expect_refused(convert("99999999999999999999\tm\t6\t4\t0\t0\t5\t0\t5\n"), "one.scen:1", "bucket");
  expect_refused(convert(""), "one.scen", "no entry can be used");
  write("my map.map", "type octile\nheight 2\nwidth 3\nmap\n...\n.x.\n");
  expect_refused(convert(kScenario), "my map.map", "\"x\"");
  write("my map.map", "\xff\xfe");
  expect_refused(convert(kScenario), "my map.map", "Line 1");
  write("my map.map", kMovingAiMap);
  EXPECT_THAT(convert(kScenario, {"--max-cells=10"}).err, HasSubstr("10"));
  EXPECT_THAT(command({"map2request", path("my map.map")}).err, HasSubstr("--scenario"));
  EXPECT_EQ(convert(kScenario, {"--robots", path("robots.csv")}).code, kBadInput);
  EXPECT_EQ(convert(kScenario, {"--radius", "-1"}).code, kBadInput);
  expect_refused(convert(kScenario, {"--linear-speed", "1e9"}), "one.scen", "linear_speed");
}

TEST_F(MovingAi, IsBoundedForLongScenarios) {
  constexpr int kSide = 400;
  std::string map = "type octile\nheight 400\nwidth 400\nmap\n";
  std::string scenario;
  for (int row = 0; row < kSide; ++row) {
    map += std::string(kSide, '.') + '\n';
    for (int column = 0; column < kSide; ++column) {
      const std::string cell = std::to_string(column) + '\t' + std::to_string(row) + '\t';
      scenario += "0\tm\t400\t400\t" + cell + cell + "0\n";
    }
  }
  write("my map.map", map);
  expect_refused(convert(scenario, {"--count", "1000000000"}), "one.scen", "takes too long");
  std::string same;
  for (int line = 0; line < kSide * kSide; ++line) same += "0\tm\t400\t400\t200\t200\t200\t200\t0\n";
  expect_refused(convert(same, {"--radius", "199"}), "one.scen", "takes too long");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
