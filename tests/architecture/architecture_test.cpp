// The layers server -> api -> core and the folders of core. All headers of the system are in one folder, so
// linking cannot enforce what may be included.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture/source_rules.h"

namespace fleetplan::architecture {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

namespace fs = std::filesystem;

/// Every C++ file of a folder by its path relative to the project root.
std::map<std::string, std::string> sources_in(const std::string& folder) {
  const fs::path root = FLEETPLAN_SOURCE_DIR;
  std::map<std::string, std::string> sources;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const fs::path& path = entry.path();
    const bool vendored = path.string().find("node_modules") != std::string::npos;
    if (vendored || (path.extension() != ".h" && path.extension() != ".cpp")) continue;
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    sources[fs::relative(path, root).generic_string()] = text.str();
  }
  return sources;
}

class Layer : public testing::TestWithParam<std::string> {};

TEST_P(Layer, FollowsItsRules) {
  const auto sources = sources_in(GetParam());
  EXPECT_FALSE(sources.empty()) << "nothing was checked";
  for (const auto& [path, text] : sources) EXPECT_THAT(violations(path, text), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Of, Layer,
                         testing::Values("include", "library", "examples", "core", "api", "server", "tests"),
                         [](const auto& layer) { return layer.param; });

TEST(Folders, DoNotIncludeEachOther) {
  std::map<std::string, std::string> sources;
  for (const std::string layer : {"core", "api", "server"}) sources.merge(sources_in(layer));
  EXPECT_THAT(mutual_includes(sources), IsEmpty()) << "move the header that causes it";
}

/// The `Name` of a line `struct Name ... {` or `class Name ... {`.
std::optional<std::string> defined_type(std::string_view line) {
  if (!line.starts_with("struct ") && !line.starts_with("class ")) return std::nullopt;
  line.remove_prefix(line.find(' ') + 1);
  const std::string_view name = line.substr(0, line.find(' '));
  const bool is_word =
      std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  const bool is_definition = is_word && line.find('{') < line.find(';') && name.size() < line.find('{');
  return is_definition ? std::optional<std::string>(name) : std::nullopt;
}

/// Two types of one name in one namespace are undefined behaviour, which no compiler reports.
TEST(Headers, DefineTypesOfDifferentNames) {
  for (const std::string folder : {"core", "api"}) {
    std::map<std::string, std::string> defined_in;
    for (const auto& [path, text] : sources_in(folder)) {
      if (!path.ends_with(".h")) continue;
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) {
        const auto name = defined_type(line);
        if (!name) continue;
        const auto [first, is_new] = defined_in.emplace(*name, path);
        EXPECT_TRUE(is_new) << *name << " is defined in " << first->second << " and in " << path;
      }
    }
    EXPECT_GT(defined_in.size(), 50U) << "nothing was checked in " << folder;
  }
}

TEST(SourceRules, AllowCoreOnlyItselfEigenAndTheStandardLibrary) {
  EXPECT_THAT(violations("core/a.cpp", "#include \"core/a.h\"\n#include <Eigen/Core>\n#include <vector>\n"),
              IsEmpty());
  EXPECT_THAT(violations("core/a.cpp", "#include \"api/json/error.h\"\n"),
              ElementsAre("core/a.cpp must not include \"api/json/error.h\""));
  EXPECT_THAT(violations("core/a.cpp", "  #  include <nlohmann/json.hpp>"),
              ElementsAre(HasSubstr("<nlohmann/json.hpp>"), HasSubstr("use nlohmann")));
  EXPECT_THAT(violations("core/a.cpp", "#include <unistd.h>\n"), ElementsAre(HasSubstr("<unistd.h>")));
}

TEST(SourceRules, AllowPublicHeadersOnlyEachOtherAndTheStandardLibrary) {
  const std::string path = "include/fleetplan/a.h";
  EXPECT_THAT(violations(path, "#pragma once\n#include <fleetplan/b.h>\n#include <vector>\n"), IsEmpty());
  EXPECT_THAT(violations(path, "#pragma once\n#include <Eigen/Core>\n"), ElementsAre(HasSubstr("Eigen")));
  EXPECT_THAT(violations(path, "#pragma once\n#include \"core/model/robot.h\"\n"),
              ElementsAre(HasSubstr("core/model/robot.h")));
  EXPECT_THAT(violations(path, "#pragma once\nthread_local int x;\n"),
              ElementsAre(HasSubstr("thread_local")));
  EXPECT_THAT(violations("library/a.cpp", "#include \"api/json/error.h\"\n"),
              ElementsAre(HasSubstr("api/json/error.h")));
}

TEST(SourceRules, AllowTheServiceInOneFolderOfTheLibraryOnly) {
  const std::string endpoints = "#include \"api/endpoints/endpoints.h\"\n";
  EXPECT_THAT(violations("library/service/a.cpp", endpoints + "#include \"library/convert.h\"\n"), IsEmpty());
  EXPECT_THAT(violations("library/service/a.cpp", "#include \"server/routes.h\"\n"),
              ElementsAre(HasSubstr("server/routes.h")));
  EXPECT_THAT(violations("library/a.cpp", endpoints), ElementsAre(HasSubstr("api/endpoints/endpoints.h")));
  EXPECT_THAT(violations("library/a.cpp", "#include \"library/service/a.h\"\n"),
              ElementsAre(HasSubstr("library/service/a.h")));
  EXPECT_THAT(violations("api/a.cpp", "#include \"library/service/a.h\"\n"),
              ElementsAre(HasSubstr("library/service/a.h")));
}

TEST(SourceRules, AllowApiToIncludeCoreButNotTheServer) {
  EXPECT_THAT(violations("api/a.cpp", "#include \"core/plan/planner.h\"\n#include <nlohmann/json.hpp>\n"),
              IsEmpty());
  EXPECT_THAT(violations("api/a.cpp", "#include \"server/routes.h\"\n"),
              ElementsAre(HasSubstr("\"server/routes.h\"")));
  EXPECT_THAT(violations("api/a.cpp", "#include <sys/socket.h>\n"), ElementsAre(HasSubstr("<sys/socket.h>")));
}

TEST(SourceRules, AllowAnswersToIncludeRequestsButNotTheOtherWay) {
  EXPECT_THAT(violations("api/response/a.cpp", "#include \"api/request/a.h\"\n"), IsEmpty());
  EXPECT_THAT(violations("api/request/a.cpp", "#include \"api/response/a.h\"\n"),
              ElementsAre(HasSubstr("\"api/response/a.h\"")));
  EXPECT_THAT(violations("api/json/a.cpp", "#include \"api/request/a.h\"\n"),
              ElementsAre(HasSubstr("\"api/request/a.h\"")));
}

TEST(SourceRules, AllowTheServerEverythingExceptTests) {
  EXPECT_THAT(violations("server/a.cpp", "#include \"api/response/reply.h\"\n#include <sys/socket.h>\n"),
              IsEmpty());
  EXPECT_THAT(violations("server/a.cpp", "#include \"tests/support/x.h\"\n"),
              ElementsAre(HasSubstr("\"tests/support/x.h\"")));
}

TEST(SourceRules, AllowTheDoorOnlyOutsideCoreAndInItsFolder) {
  const std::string include = "#include \"core/plan/planner.h\"\n";
  EXPECT_THAT(violations("core/plan/a.cpp", include), IsEmpty());
  EXPECT_THAT(violations("api/endpoints/a.cpp", include), IsEmpty());
  for (const std::string path :
       {"core/compile/instance.h", "core/sipp/a.cpp", "core/lns/a.cpp", "core/verify/a.cpp"}) {
    EXPECT_THAT(violations(path, "#pragma once\n" + include),
                ElementsAre(path + " must not include \"core/plan/planner.h\""));
  }
}

TEST(SourceRules, RejectPlanningOfAllRobotsInFoldersForOneRobot) {
  for (const std::string folder :
       {"geometry", "map", "model", "compile", "runtime", "reservation", "bounds", "sipp"}) {
    const std::string path = "core/" + folder + "/a.cpp";
    EXPECT_THAT(violations(path, "#include \"core/fleet/plan_state.h\"\n"),
                ElementsAre(path + " must not include \"core/fleet/plan_state.h\""));
    EXPECT_THAT(violations(path, "#include \"core/lns/incumbent.h\"\n"), ElementsAre(HasSubstr("core/lns/")));
    EXPECT_THAT(violations(path, "#include \"core/map/lattice.h\"\n"), IsEmpty());
  }
  EXPECT_THAT(violations("core/lns/a.cpp", "#include \"core/fleet/plan_state.h\"\n"), IsEmpty());
}

TEST(SourceRules, RejectTheSearchInTheChecker) {
  const std::string path = "core/verify/a.cpp";
  for (const std::string header :
       {"core/reservation/reservation_table.h", "core/sipp/aa_sipp.h", "core/fleet/plan_state.h",
        "core/lns/incumbent.h", "core/bounds/lower_bound.h", "core/plan/a.h",
        "core/geometry/disk_motion.h"}) {
    EXPECT_THAT(violations(path, "#include \"" + header + "\"\n"),
                ElementsAre(path + " must not include \"" + header + "\""));
  }
  EXPECT_THAT(violations(path, "#include \"core/geometry/position.h\"\n#include \"core/model/plan.h\"\n"),
              IsEmpty());
}

TEST(SourceRules, RejectTheReadingOfRequestsInTheChecker) {
  for (const std::string header : {"core/compile/instance.h", "core/model/served.h", "core/model/loads.h"}) {
    EXPECT_THAT(violations("core/verify/a.cpp", "#include \"" + header + "\"\n"), SizeIs(1));
    EXPECT_THAT(violations("core/advance/a.cpp", "#include \"core/model/loads.h\"\n"), IsEmpty());
  }
}

TEST(SourceRules, RejectRobotsWhereTheyAreCompiled) {
  const std::string reads = "double f(const Robot& robot) { return robot.radius; }\n";
  EXPECT_THAT(violations("core/sipp/a.cpp", reads), ElementsAre(HasSubstr("Robot")));
  EXPECT_THAT(violations("core/moves/a.cpp", reads), SizeIs(1));
  EXPECT_THAT(violations("core/plan/collect_plan.cpp", reads), IsEmpty());
  EXPECT_THAT(violations("core/compile/a.cpp", reads), IsEmpty());
  EXPECT_THAT(violations("core/sipp/a.cpp", "RobotPlan plan;  // of a Robot\n"), IsEmpty());
}

TEST(SourceRules, RequireIncludesRelativeToTheProject) {
  EXPECT_THAT(violations("core/map/a.cpp", "#include \"../model/robot.h\"\n"), ElementsAre(HasSubstr("../")));
  EXPECT_THAT(violations("core/map/a.cpp", "#include \"core/../api/error.h\"\n"),
              ElementsAre(HasSubstr("..")));
  EXPECT_THAT(violations("core/map/a.cpp", "#include \"b.h\"\n"), ElementsAre(HasSubstr("\"b.h\"")));
}

TEST(SourceRules, RejectFunctionsWithOtherDigitsOnOtherMachines) {
  for (const char* file : {"core/a.cpp", "api/a.cpp", "library/a.cpp"}) {
    EXPECT_THAT(violations(file, "double x = std::atan2(1.0, 2.0);\n"), ElementsAre(HasSubstr("std::atan2")));
    EXPECT_THAT(violations(file, "double x = std::sqrt(2.0);\n"), IsEmpty());
  }
  EXPECT_THAT(violations("server/a.cpp", "double x = std::pow(2.0, 0.5);\n"), IsEmpty());
}

TEST(SourceRules, RejectTheEnvironmentAndOutputInCore) {
  EXPECT_THAT(violations("core/a.cpp", "auto* home = std::getenv(\"HOME\");\n"),
              ElementsAre("core/a.cpp must not use getenv"));
  EXPECT_THAT(violations("core/a.cpp", "std::cerr << 1;\n"), ElementsAre(HasSubstr("cerr")));
  EXPECT_THAT(violations("server/a.cpp", "std::getenv(\"HOME\");\n"), IsEmpty());
}

TEST(SourceRules, IgnoreCommentsAndStrings) {
  EXPECT_THAT(violations("core/a.cpp",
                         "// getenv\n/* cerr\n cout */ const char* s = \"getenv \\\" cerr\"; int my_exit;\n"),
              IsEmpty());
  EXPECT_THAT(violations("core/a.cpp", "/* a */ getenv(\"x\"); // b\n"), ElementsAre(HasSubstr("getenv")));
  EXPECT_THAT(violations("core/a.cpp", "int n = 1'000; std::exit('\\'');\n"), ElementsAre(HasSubstr("exit")));
}

TEST(SourceRules, RequirePragmaOnceAtTheBeginningOfHeaders) {
  EXPECT_THAT(violations("core/a.h", "// A file.\n\n#pragma once\n"), IsEmpty());
  EXPECT_THAT(violations("core/a.h", "#include <vector>\n#pragma once\n"),
              ElementsAre("core/a.h does not begin with #pragma once"));
  EXPECT_THAT(violations("tests/a.h", "#pragma once\nusing namespace std;\n"),
              ElementsAre(HasSubstr("using namespace")));
}

TEST(SourceRules, RejectStopConditionsThatKnowNothingOfTheRequest) {
  for (const std::string made :
       {"auto s = StopCondition::never();", "core::StopCondition stop(then);",
        "f(StopCondition(then, token));", "core::Work w = core::Work::unbounded();"}) {
    EXPECT_THAT(violations("api/a.cpp", "void f() { " + made + " }\n"), ElementsAre(HasSubstr("Work")))
        << made;
    EXPECT_THAT(violations("tests/a.cpp", "void f() { " + made + " }\n"), IsEmpty());
  }
  EXPECT_THAT(
      violations("core/a.cpp", "StopCondition sooner(const StopCondition& stop) { return stop.until(t); }\n"),
      IsEmpty());
  EXPECT_THAT(violations("core/a.cpp", "const auto last = stop.even_if_cancelled(t);\n"), IsEmpty());
}

TEST(SourceRules, RejectCountersBetweenQuestionsOfStopConditions) {
  for (const std::string poll :
       {"if (++steps % kN == 0 && stop.met()) return;", "if (k % kN == kN - 1 && stop_->met()) return;",
        "if (++steps_ % kN == 0) stopped_ = stopped_ || stop_.met();",
        "if (k % kN == 0) { if (stop.met()) return; }",
        "const auto goes_on = [&] { return ++n % kN != 0 || !stop.met(); };",
        "if (work >= kN) { work = 0; if (stop.met()) return; }",
        "if (work >= kN) { if (stop.met()) return; work = 0; }",
        "if (work_ < kN) return over_; work_ = 0; over_ = over_ || stop_.met();",
        "const bool asks = steps == kStepsBetweenPolls; if (asks && stop.met()) return;",
        "left = kStopStride; g(stop);"}) {
    for (const std::string file : {"core/a.cpp", "api/a.cpp", "library/a.cpp"}) {
      EXPECT_THAT(violations(file, "void f() { " + poll + " }\n"), ElementsAre(HasSubstr("StopStride")))
          << poll;
    }
    EXPECT_THAT(violations("tests/a.cpp", "void f() { " + poll + " }\n"), IsEmpty());
  }
  for (const std::string poll :
       {"StopStride stride(stop, is_slow ? 1 : kStepsBetweenPolls); if (stride.met_at_step()) return;",
        "constexpr int kStopStride = 64; StopStride stride = StopStride::from_first(stop, kStopStride);",
        "for (int k = 0; k < n && !stop.met(); ++k) g(k % 2);", "int n = 0; if (stop.met()) return;"}) {
    EXPECT_THAT(violations("core/a.cpp", "void f() { " + poll + " }\n"), IsEmpty()) << poll;
  }
}

TEST(SourceRules, RejectLoopsInLoopsThatNothingBounds) {
  const auto loops_of = [](const std::string& function) {
    return violations("core/a.cpp", "namespace a {\nclass B {\n" + function + "};\n}\n");
  };
  const auto rejected = ElementsAre(HasSubstr("core/a.cpp:3 has a loop in a loop"));
  EXPECT_THAT(loops_of("int f() {\n  for (int i : all) {\n    while (g(i)) h();\n  }\n}\n"), rejected);
  EXPECT_THAT(loops_of("int f() {\n  for (int i : all)\n    for (int k : all) h(i, k);\n}\n"), rejected);
  EXPECT_THAT(loops_of("int f() {\n  do {\n    if (a) {\n      for (;;) b();\n    }\n  } while (c);\n}\n"),
              rejected);
  EXPECT_THAT(loops_of("int f() {\n  run([&] { for (int i : all) { for (;;) b(); } });\n}\n"), rejected);
  EXPECT_THAT(loops_of("int f() {\n  for (int i : all) h(i);\n  for (int k : all) h(k);\n}\n"), IsEmpty());
  EXPECT_THAT(loops_of("int f() {\n  for (int i : all) {\n    h(i);\n  }\n  while (a) {\n  }\n}\n"),
              IsEmpty());
  EXPECT_THAT(loops_of("int f(Work& work) {\n  for (int i : all)\n    for (int k : all) h(work);\n}\n"),
              IsEmpty());
  EXPECT_THAT(
      loops_of("int f() {\n  for (int i : all) {\n    if (work_.met()) break;\n    while (b) c();\n  }\n}\n"),
      IsEmpty());
  EXPECT_THAT(
      loops_of("int f() {\n  for (int i : all) {\n    if (stop_.met()) break;\n    while (b) c();\n  }\n}\n"),
      IsEmpty());
  EXPECT_THAT(loops_of("int f() {\n  for (int i : all)\n    while (b && !stride_.met_at_step()) c();\n}\n"),
              IsEmpty());
  EXPECT_THAT(loops_of("int f() {\n  for (int i : all)\n    for (;;) h(i * stride_);\n}\n"), SizeIs(1));
  EXPECT_THAT(
      loops_of("int f() {\n  // Bounded: eight neighbours.\n  for (int i : all)\n    for (;;) h();\n}\n"),
      IsEmpty());
}

TEST(SourceRules, FindFoldersThatIncludeEachOther) {
  const std::string of_map = "#include \"core/map/deep/b.h\"\n";
  const std::string of_model = "#include \"core/model/a.h\"\n";
  const std::string of_api = "#include \"api/c.h\"\n";
  EXPECT_THAT(mutual_includes({{"core/model/a.h", of_map}, {"core/map/deep/b.h", of_model}}),
              ElementsAre("core/map and core/model"));
  EXPECT_THAT(mutual_includes({{"api/c.h", "#include \"api/json/d.h\"\n"}, {"api/json/d.h", of_api}}),
              ElementsAre("api and api/json"));
  EXPECT_THAT(mutual_includes({{"core/model/a.h", of_map + of_model}, {"core/map/b.h", "// " + of_model}}),
              IsEmpty());
  const std::string of_robots = "#include \"api/request/fleet/robots.h\"\n";
  const std::string of_zones = "#include \"api/request/map/image/zones.h\"\n";
  EXPECT_THAT(mutual_includes(
                  {{"api/request/map/image/zones.h", of_robots}, {"api/request/fleet/robots.h", of_zones}}),
              ElementsAre("api/request/fleet and api/request/map"));
  EXPECT_THAT(mutual_includes({{"api/request/a.h", of_robots},
                               {"api/request/fleet/robots.h", "#include \"api/request/a.h\"\n"}}),
              IsEmpty());
}

TEST(SourceRules, RejectOtherFolders) {
  EXPECT_THAT(violations("lib/a.cpp", ""), ElementsAre("lib/a.cpp belongs to no layer"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::architecture
