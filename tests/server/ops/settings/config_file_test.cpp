// Settings from a file.

#include "server/ops/settings/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/ops/settings/settings.h"
#include "tests/server/support/environment.h"
#include "tests/support/temporary_file.h"

namespace fleetplan::server {
namespace TEST_FILE {

using support::TemporaryFile;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::variant<Settings, SettingsExit> parsed(const std::string& content, std::vector<std::string> flags = {}) {
  const TemporaryFile file(content);
  flags.insert(flags.end(), {"--config", file.path()});
  return parse_settings(std::move(flags));
}

Settings settings_of(const std::string& content, std::vector<std::string> flags = {}) {
  auto result = parsed(content, std::move(flags));
  const auto* exit = std::get_if<SettingsExit>(&result);
  EXPECT_EQ(exit, nullptr) << exit->text;
  return exit == nullptr ? std::get<Settings>(result) : Settings{};
}

std::string fault_of(const std::string& content) {
  auto result = parsed(content);
  const auto* exit = std::get_if<SettingsExit>(&result);
  EXPECT_NE(exit, nullptr) << content;
  if (exit == nullptr) return {};
  EXPECT_EQ(exit->code, 2);
  return exit->text;
}

TEST(ConfigFile, SetsTheFlagsItNames) {
  const auto settings = settings_of(
      "# a comment\n"
      "port = 9000\n"
      "host = \"0.0.0.0\"  # all\n"
      "max-body = 2MiB\n"
      "\n"
      "queue=0\n"
      "admin-port = 0\n"
      "drain-delay-ms = 2500\n"
      "cors-origin = [\"https://a.example\", \"https://b.example\"]\n");
  EXPECT_EQ(settings.port, 9000);
  EXPECT_EQ(settings.host, "0.0.0.0");
  EXPECT_EQ(settings.limits.max_body, 2u << 20);
  EXPECT_EQ(settings.queue, 0u);
  EXPECT_EQ(settings.admin_port, 0);
  EXPECT_EQ(settings.drain_delay, std::chrono::milliseconds(2500));
  EXPECT_THAT(settings.cors_origins, ElementsAre("https://a.example", "https://b.example"));
  EXPECT_EQ(settings.connections, 1024u) << "the rest keeps its default";
}

TEST(ConfigFile, IsOverriddenByTheEnvironmentAndByFlags) {
  const Environment port("FLEETPLAN_PORT", "9001");
  const Environment depth("FLEETPLAN_MAX_DEPTH", "11");
  const std::string file = "port = 9000\nmax-depth = 10\nmax-robots = 12\n";
  const auto settings = settings_of(file, {"--port", "9002"});
  EXPECT_EQ(settings.port, 9002);
  EXPECT_EQ(settings.limits.max_depth, 11);
  EXPECT_EQ(settings.limits.max_robots, 12u);
}

TEST(ConfigFile, CanBeNamedByTheEnvironment) {
  const TemporaryFile file("port = 9003\n");
  const Environment config("FLEETPLAN_CONFIG", file.path().c_str());
  const auto result = parse_settings({});
  ASSERT_TRUE(std::holds_alternative<Settings>(result)) << std::get<SettingsExit>(result).text;
  EXPECT_EQ(std::get<Settings>(result).port, 9003);
}

TEST(ConfigFile, MayBeEmpty) { EXPECT_EQ(settings_of("").port, 8080); }

TEST(ConfigFile, IsRejectedWithItsNameAndTheFault) {
  EXPECT_THAT(fault_of("prot = 9000\n"), AllOf(HasSubstr("--config: "), HasSubstr("no setting 'prot'")));
  EXPECT_THAT(fault_of("port = 70000\n"), AllOf(HasSubstr("--config: "), HasSubstr("--port")));
  EXPECT_THAT(fault_of("port = many\n"), HasSubstr("--port"));
  EXPECT_THAT(fault_of("port\n"), HasSubstr("'port' has no value"));
  EXPECT_THAT(fault_of("port =\n"), HasSubstr("--port"));
  EXPECT_THAT(fault_of("port = 1\nport = 2\n"), HasSubstr("port"));
  EXPECT_THAT(fault_of("port = 1\nhost = ::1\nport = 1\n"), HasSubstr("'port' is set twice"));
  EXPECT_THAT(fault_of("[server]\nport = 1\n"), HasSubstr("no setting 'server"));
  EXPECT_THAT(fault_of("config = /etc/other\n"), HasSubstr("no setting 'config'"));
  EXPECT_THAT(fault_of("help = true\n"), HasSubstr("no setting 'help'"));
  EXPECT_THAT(fault_of("max-body = 1XB\n"), HasSubstr("--max-body"));
  EXPECT_THAT(fault_of("max-body = 0\n"), HasSubstr("--max-body"));
}

TEST(ConfigFile, IsRejectedWhenMissing) {
  for (const char* path : {"/no/such/file", "/"}) {
    const auto result = parse_settings({"--config", path});
    ASSERT_TRUE(std::holds_alternative<SettingsExit>(result)) << path;
    EXPECT_EQ(std::get<SettingsExit>(result).code, 2);
    EXPECT_THAT(std::get<SettingsExit>(result).text, AllOf(HasSubstr("--config"), HasSubstr(path)));
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
