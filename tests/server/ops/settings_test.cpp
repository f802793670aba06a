#include "server/ops/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/ops/process.h"
#include "tests/server/support/environment.h"
#include "tests/support/temporary_file.h"

namespace fleetplan::server {
namespace TEST_FILE {

using support::TemporaryFile;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Settings settings_of(std::vector<std::string> arguments) {
  auto parsed = parse_settings(std::move(arguments));
  const auto* exit = std::get_if<SettingsExit>(&parsed);
  EXPECT_EQ(exit, nullptr) << (exit != nullptr ? exit->text : "");
  return exit == nullptr ? std::get<Settings>(parsed) : Settings{};
}

SettingsExit exit_of(std::vector<std::string> arguments) {
  auto parsed = parse_settings(std::move(arguments));
  EXPECT_TRUE(std::holds_alternative<SettingsExit>(parsed));
  const auto* exit = std::get_if<SettingsExit>(&parsed);
  return exit != nullptr ? *exit : SettingsExit{};
}

TEST(Settings, HaveTheirDefaults) {
  const auto settings = settings_of({});
  EXPECT_EQ(settings.host, "127.0.0.1");
  EXPECT_EQ(settings.port, 8080);
  EXPECT_EQ(settings.workers, cpus_granted());
  EXPECT_EQ(settings.queue, 4u * static_cast<std::size_t>(settings.workers));
  EXPECT_EQ(settings.connections, 1024u);
  EXPECT_EQ(settings.limits.max_body, 32u << 20);
  EXPECT_EQ(settings.limits.max_plan_memory, 256u << 20);
  EXPECT_EQ(settings.map_cache, 128u << 20);
  EXPECT_EQ(settings.limits.max_budget_ms, 120'000);
  EXPECT_EQ(settings.drain, std::chrono::seconds(10));
  EXPECT_EQ(settings.log_level, "info");
  EXPECT_EQ(settings.admin_port, std::nullopt);
  EXPECT_FALSE(settings.token);
  EXPECT_TRUE(settings.cors_origins.empty());
  EXPECT_TRUE(settings.frame_ancestors.empty());
  EXPECT_EQ(settings.drain_delay, std::chrono::milliseconds(0));
}

TEST(Settings, ProbeHealthByFlagOnly) {
  EXPECT_FALSE(settings_of({}).healthcheck);
  EXPECT_TRUE(settings_of({"--healthcheck"}).healthcheck);
  const support::TemporaryFile file("healthcheck = true\n");
  EXPECT_EQ(exit_of({"--config", file.path()}).code, 2);
}

TEST(Settings, ComeFromFlags) {
  const auto settings =
      settings_of({"--port", "9000", "--workers=3", "--max-body", "2MiB", "--max-plan-memory", "96MiB",
                   "--map-cache", "0", "--idle-timeout-ms", "7"});
  EXPECT_EQ(settings.port, 9000);
  EXPECT_EQ(settings.workers, 3);
  EXPECT_EQ(settings.queue, 12u);
  EXPECT_EQ(settings.limits.max_body, 2u << 20);
  EXPECT_EQ(settings.limits.max_plan_memory, 96u << 20);
  EXPECT_EQ(settings.map_cache, 0u);
  EXPECT_EQ(settings.idle_timeout, std::chrono::milliseconds(7));
  EXPECT_EQ(settings_of({"--max-unsent", "0x200000"}).max_unsent, 2u << 20);
}

TEST(Settings, ReadTheTokenFromAFile) {
  const support::TemporaryFile file("open-sesame\n");
  const auto settings = settings_of({"--auth-token-file", file.path()});
  ASSERT_TRUE(settings.token);
  EXPECT_TRUE(settings.token->admits("Bearer open-sesame"));
  EXPECT_EQ(exit_of({"--auth-token-file", ""}).code, 2)
      << "an unset variable of a script must not disable authentication";
  EXPECT_EQ(exit_of({"--config", ""}).code, 2);
  const support::TemporaryFile empty("\n");
  const auto exit = exit_of({"--auth-token-file", empty.path()});
  EXPECT_EQ(exit.code, 2);
  EXPECT_EQ(exit.text.find("--auth-token-file: " + empty.path() + ": it is empty"), 0u) << exit.text;
}

TEST(Settings, AcceptOriginsRepeatedOrCommaSeparated) {
  const std::vector<std::string> both{"https://a.example", "http://b.example:3000"};
  EXPECT_EQ(settings_of({"--cors-origin", "https://a.example,http://b.example:3000"}).cors_origins, both);
  EXPECT_EQ(settings_of({"--cors-origin", both[0], "--cors-origin", both[1]}).cors_origins, both);
  EXPECT_EQ(settings_of({"--frame-ancestors", "https://a.example,http://b.example:3000"}).frame_ancestors,
            both);
  EXPECT_EQ(settings_of({"--trusted-proxy", "10.0.0.7,2001:db8::/32"}).trusted_proxies.size(), 2u);
  const Environment origins("FLEETPLAN_CORS_ORIGIN", "https://a.example,http://b.example:3000");
  EXPECT_EQ(settings_of({}).cors_origins, both);
  EXPECT_EQ(settings_of({"--cors-origin", "*"}).cors_origins, std::vector<std::string>{"*"});
}

TEST(Settings, ComeFromTheEnvironmentUnlessAFlagIsGiven) {
  const Environment port("FLEETPLAN_PORT", "9001");
  const Environment body("FLEETPLAN_MAX_BODY", "4096");
  const Environment queue("FLEETPLAN_QUEUE", "0");
  EXPECT_EQ(settings_of({}).port, 9001);
  EXPECT_EQ(settings_of({}).limits.max_body, 4096u);
  EXPECT_EQ(settings_of({}).queue, 0u);
  EXPECT_EQ(settings_of({"--port", "9002"}).port, 9002);
}

TEST(Settings, TreatAnEmptyEnvironmentValueAsNotSet) {
  const Environment port("FLEETPLAN_PORT", "");
  EXPECT_EQ(settings_of({}).port, 8080);
}

TEST(Settings, RejectBadValuesAndNameTheFlag) {
  for (const char* argument : {"--port=65536",
                               "--port=x",
                               "--workers=0",
                               "--queue=-1",
                               "--max-body=0",
                               "--max-plan-memory=1023KiB",
                               "--max-plan-memory=2TiB",
                               "--map-cache=2TiB",
                               "--max-body=-5",
                               "--max-body=1XB",
                               "--max-body=99999999999999999999999",
                               "--max-unsent=99999999999999999999999",
                               "--max-cells=0",
                               "--max-robots=0",
                               "--max-depth=0",
                               "--max-goals=0",
                               "--max-actions=0",
                               "--max-obstacles=0",
                               "--max-obstacle-entries=0",
                               "--max-zones=0",
                               "--max-zone-corners=2",
                               "--default-budget-ms=0",
                               "--max-budget-ms=0",
                               "--idle-timeout-ms=0",
                               "--read-timeout-ms=0",
                               "--drain-ms=-1",
                               "--log-level=loud",
                               "--connections=0",
                               "--web-root=/no/such/folder",
                               "--default-budget-ms=200000",
                               "--admin-port=-1",
                               "--admin-port=off",
                               "--auth-token-file=/no/such/file",
                               "--cors-origin=a.example",
                               "--frame-ancestors=https://a.example; script-src *",
                               "--trusted-proxy=10.0.0.0/40",
                               "--drain-delay-ms=-1",
                               "--config=/no/such/file"}) {
    const auto exit = exit_of({argument});
    const std::string flag(argument, std::string(argument).find('='));
    EXPECT_EQ(exit.code, 2) << argument;
    EXPECT_NE(exit.text.find(flag), std::string::npos) << argument << ": " << exit.text;
  }
  EXPECT_EQ(exit_of({"--no-such-flag"}).code, 2);
  EXPECT_EQ(exit_of({"stray"}).code, 2);
}

TEST(Settings, RejectABadEnvironmentValue) {
  const Environment port("FLEETPLAN_PORT", "many");
  EXPECT_EQ(exit_of({}).code, 2);
}

TEST(Settings, LimitTheDefaultBudgetToTheMaximum) {
  EXPECT_EQ(settings_of({"--max-budget-ms", "300"}).limits.default_budget_ms, 300);
}

TEST(Settings, AreDescribedByHelp) {
  const auto help = exit_of({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.text.find("FLEETPLAN_MAX_BODY"), std::string::npos);
  EXPECT_NE(help.text.find("32MiB"), std::string::npos);
  const auto version = exit_of({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.text, "fleetplan " FLEETPLAN_VERSION "\n");
}

// From a file.

std::variant<Settings, SettingsExit> parsed(const std::string& content, std::vector<std::string> flags = {}) {
  const TemporaryFile file(content);
  flags.insert(flags.end(), {"--config", file.path()});
  return parse_settings(std::move(flags));
}

Settings settings_of_file(const std::string& content, std::vector<std::string> flags = {}) {
  auto result = parsed(content, std::move(flags));
  const auto* exit = std::get_if<SettingsExit>(&result);
  EXPECT_EQ(exit, nullptr) << exit->text;
  return exit == nullptr ? std::get<Settings>(result) : Settings{};
}

std::string fault_of_file(const std::string& content) {
  auto result = parsed(content);
  const auto* exit = std::get_if<SettingsExit>(&result);
  EXPECT_NE(exit, nullptr) << content;
  if (exit == nullptr) return {};
  EXPECT_EQ(exit->code, 2);
  return exit->text;
}

TEST(ConfigFile, SetsTheFlagsItNames) {
  const auto settings = settings_of_file(
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
  const auto settings = settings_of_file(file, {"--port", "9002"});
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

TEST(ConfigFile, MayBeEmpty) { EXPECT_EQ(settings_of_file("").port, 8080); }

TEST(ConfigFile, IsRejectedWithItsNameAndTheFault) {
  EXPECT_THAT(fault_of_file("prot = 9000\n"), AllOf(HasSubstr("--config: "), HasSubstr("no setting 'prot'")));
  EXPECT_THAT(fault_of_file("port = 70000\n"), AllOf(HasSubstr("--config: "), HasSubstr("--port")));
  EXPECT_THAT(fault_of_file("port = many\n"), HasSubstr("--port"));
  EXPECT_THAT(fault_of_file("port\n"), HasSubstr("'port' has no value"));
  EXPECT_THAT(fault_of_file("port =\n"), HasSubstr("--port"));
  EXPECT_THAT(fault_of_file("port = 1\nport = 2\n"), HasSubstr("port"));
  EXPECT_THAT(fault_of_file("port = 1\nhost = ::1\nport = 1\n"), HasSubstr("'port' is set twice"));
  EXPECT_THAT(fault_of_file("[server]\nport = 1\n"), HasSubstr("no setting 'server"));
  EXPECT_THAT(fault_of_file("config = /etc/other\n"), HasSubstr("no setting 'config'"));
  EXPECT_THAT(fault_of_file("help = true\n"), HasSubstr("no setting 'help'"));
  EXPECT_THAT(fault_of_file("max-body = 1XB\n"), HasSubstr("--max-body"));
  EXPECT_THAT(fault_of_file("max-body = 0\n"), HasSubstr("--max-body"));
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
