#include "server/command/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/printable.h"
#include "api/response/draw_plan.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "server/http/cpp_httplib.h"
#include "server/jobs/workers.h"
#include "server/service/service.h"

namespace fleetplan::server {

InputFault input_fault(const std::string& file, std::size_t line, const std::string& detail) {
  const std::string where = shown_name(file) + ':' + (line > 0 ? std::to_string(line) + ':' : "");
  return {api::printable(where + ' ' + detail)};
}

api::Result<std::string, InputFault> read_file(const std::string& name, std::istream& in,
                                               std::size_t max_bytes) {
  std::ifstream file;
  if (name != "-") file.open(name, std::ios::binary);
  std::istream& source = name == "-" ? in : file;
  if (name != "-" && !file.is_open()) return input_fault(name, 0, "cannot read the file; does it exist?");
  std::string text;
  std::array<char, std::size_t{1} << 16> part{};
  while (source && text.size() <= max_bytes) {
    source.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(source.gcount()));
  }
  if (source.bad()) return input_fault(name, 0, "cannot read the file; is it a folder?");
  if (text.size() > max_bytes) {
    return input_fault(name, 0, "the file has more than " + std::to_string(max_bytes) + " bytes.");
  }
  return text;
}

std::string shown_name(const std::string& file) { return file == "-" ? "stdin" : file; }

bool write_file(const std::string& name, const std::string& text) {
  std::ofstream file(name, std::ios::binary);
  file << text;
  file.close();
  return !file.fail();
}

int write_output(const std::string& name, const std::string& text, const Streams& streams) {
  if (name.empty()) {
    streams.out << api::printable(text, api::Lines::kept) << std::flush;
  } else if (!write_file(name, text)) {
    return fail(streams, kFailed, "cannot write " + name);
  }
  return kSolved;
}

int refuse(const InputFault& fault, const Streams& streams) {
  streams.err << fault.line << '\n';
  return kBadInput;
}

int fail(const Streams& streams, int code, const std::string& message) {
  streams.err << "fleetplan: " << api::printable(message) << '\n';
  return code;
}

std::optional<double> read_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

namespace {

using Json = nlohmann::json;

/// A command that answers a request.
struct RequestCommand {
  Service::Endpoint endpoint;
  std::string request = "-";  // file names; "-": the standard input
  std::string output;         // empty: the standard output
  std::string svg;            // picture of the plan; empty: none
  std::string png;            // picture of the plan; empty: none
  bool quiet = false;         // shows no progress
  int workers = 1;
  api::Limits limits;
};

/// Runs the tasks of the only job on all workers, whose threads begin with the first tasks.
class AllWorkers : public core::Executor {
 public:
  explicit AllWorkers(int workers) : workers_(static_cast<std::size_t>(workers)) {}

  void run_on(std::size_t threads, std::size_t count, const Task& task) override {
    if (!helpers_) {
      helpers_.emplace(workers_);
      helpers_->set_computing(1);
    }
    helpers_->run(threads, count, task);
  }

 private:
  const std::size_t workers_;
  std::optional<Helpers> helpers_;
};

/// The most time for one picture: more than the largest maps and plans take.
constexpr std::chrono::seconds kMaxPictureTime{20};

/// Writes the progress of planning to a terminal, on one line that it overwrites.
class TerminalProgress : public api::PlanEvents {
 public:
  explicit TerminalProgress(std::ostream& terminal) : terminal_(terminal) {}
  ~TerminalProgress() override {
    if (has_written_) terminal_ << "\r\033[K" << std::flush;
  }

  void begin(const api::PlanProgress& progress) override { show(progress); }
  void progress(const api::PlanProgress& progress) override {
    if (Clock::now() >= next_) show(progress);
  }
  void incumbent(std::string /*answer*/) override {}

 private:
  using Clock = std::chrono::steady_clock;

  void show(const api::PlanProgress& progress) {
    constexpr std::chrono::milliseconds kPause{100};
    next_ = Clock::now() + kPause;
    has_written_ = true;
    terminal_ << "\r\033[K";
    if (progress.simulation) {
      terminal_ << progress.simulation->done << " of " << progress.simulation->runs << " runs";
    } else if (progress.margins) {
      const core::MarginProgress& margins = *progress.margins;
      const bool is_planned = margins.stage == core::MarginProgress::Stage::plan;
      terminal_ << "candidate " << margins.candidate + 1 << " of " << margins.candidates << ": ";
      if (is_planned) {
        terminal_ << "planning";
      } else {
        terminal_ << margins.runs << " runs, " << margins.bad << " bad";
      }
    } else {
      terminal_ << progress.planner.planned << " of " << progress.robots << " robots planned";
      if (const auto& best = progress.planner.best) terminal_ << ", flowtime " << best->flowtime << " s";
    }
    terminal_ << std::flush;
  }

  std::ostream& terminal_;
  Clock::time_point next_ = {};
  bool has_written_ = false;
};

/// Returns a refusal as lines for people: "robots.json: /robots/0/start: the disk overlaps a blocked cell".
std::string in_lines(const api::Reply& reply, const std::string& request) {
  const Json problem = Json::parse(reply.body);
  const auto line = [&](const std::string& text) { return input_fault(request, 0, text).line + '\n'; };
  const auto faults = problem.value("errors", Json::array());
  if (faults.empty()) return line(problem.value("detail", ""));
  std::string lines;
  for (const Json& fault : faults)
    lines += line(fault.value("pointer", "") + ": " + fault.value("detail", ""));
  const std::size_t total = problem.value("errors_total", faults.size());
  if (total > faults.size()) lines += line("and " + std::to_string(total - faults.size()) + " more faults");
  return lines;
}

int exit_code_of(const api::Reply& reply) {
  if (reply.status != 200) {
    const bool is_refused = reply.status == 400 || reply.problem == "invalid_request";
    return is_refused ? kBadInput : kFailed;
  }
  if (reply.outcome) {
    using Status = api::PlanOutcome::Status;
    return reply.outcome->status == Status::solved    ? kSolved
           : reply.outcome->status == Status::partial ? kPartial
                                                      : kNone;
  }
  const Json answer = Json::parse(reply.body);
  return answer.value("valid", true) && answer.value("met", true) ? kSolved : kPartial;
}

/// Draws the pictures that a command asks for, of the plan that is answered.
class Pictures {
 public:
  explicit Pictures(const RequestCommand& command) : command_(command) {}

  void draw(const core::Problem& problem, const core::Plan& plan) {
    using Clock = std::chrono::steady_clock;
    if (!command_.svg.empty()) {
      svg_ = api::draw_plan(problem, plan, core::StopCondition(Clock::now() + kMaxPictureTime));
    }
    if (!command_.png.empty()) {
      png_ = api::paint_plan(problem, plan, core::StopCondition(Clock::now() + kMaxPictureTime));
    }
  }

  /// Writes the files. Returns the first file that could not be written, if any.
  std::optional<std::string> write() const {
    const auto is_missing = [](const std::string& file, const std::optional<std::string>& picture) {
      return !file.empty() && !(picture && write_file(file, *picture));
    };
    if (is_missing(command_.svg, svg_)) return command_.svg;
    if (is_missing(command_.png, png_)) return command_.png;
    return std::nullopt;
  }

 private:
  const RequestCommand& command_;
  std::optional<std::string> svg_;
  std::optional<std::string> png_;
};

/// Answers the request as the service would. Returns the exit code.
int answer_request(const RequestCommand& command, const Streams& streams) {
  const auto body = read_file(command.request, streams.in);
  if (!body) return fail(streams, kBadInput, body.failure().line);
  Pictures pictures(command);
  api::RequestContext context;
  AllWorkers workers(command.workers);
  context.request_id = "command-line";
  context.limits = command.limits;
  context.executor = &workers;
  context.answered = [&](const core::Problem& problem, const core::Plan& plan) {
    pictures.draw(problem, plan);
  };
  api::Reply reply;
  {
    std::optional<TerminalProgress> progress;
    if (streams.shows_progress && !command.quiet) progress.emplace(streams.err);
    if (progress) context.events = &*progress;
    reply = command.endpoint(*body, context);
  }
  const int code = exit_code_of(reply);
  if (reply.status != 200) {
    streams.err << in_lines(reply, command.request);
    return code;
  }
  if (!reply.body.ends_with('\n')) reply.body += '\n';
  if (const int failed = write_output(command.output, reply.body, streams)) return failed;
  if (const auto file = pictures.write()) return fail(streams, kFailed, "cannot write " + *file);
  return code;
}

struct Command {
  std::string_view word;
  std::string_view summary;
  Service::Endpoint Service::*endpoint;
};

constexpr std::array<Command, 11> kCommands{{
    {"plan", "Plan the motions of all robots", &Service::plan},
    {"validate", "Check plans: exit code 2 if they are not valid", &Service::validate},
    {"simulate", "Execute plans many times with disturbances", &Service::simulate},
    {"margins", "Find margins that hold: exit code 2 if none meets the aim", &Service::margins},
    {"advance", "Move a request to a later moment of its plans", &Service::advance},
    {"dependencies", "List what robots must wait for in a plan", &Service::dependencies},
    {"retime", "Give a plan new times after delays", &Service::retime},
    {"matrix", "Tell how long a robot takes between poses", &Service::matrix},
    {"assign", "Give tasks to robots", &Service::assign},
    {"export-vda5050", "Turn plans into orders of VDA 5050", &Service::vda5050},
    {"import-vda5050", "Turn states of VDA 5050 into states of robots", &Service::import_vda5050},
}};

/// The meaning of the arguments of a command.
struct Arguments {
  RequestCommand request;
  std::string example;
  std::string map;
  std::string robots;
  std::string scenario;
  ScenarioFleet fleet;
};

int show_examples(const std::string& name, const Service& service, const Streams& streams) {
  if (name.empty()) {
    for (const auto& example : service.examples) streams.out << example.name << '\n';
    return kSolved;
  }
  const auto& examples = service.examples;
  const auto found = std::find_if(examples.begin(), examples.end(),
                                  [&](const Service::Example& example) { return example.name == name; });
  if (found == examples.end()) {
    return fail(streams, kBadInput, "there is no example " + name + "; `fleetplan examples` lists them");
  }
  streams.out << found->body;
  return kSolved;
}

void add_commands(CLI::App& app, std::string_view word, Arguments& arguments) {
  RequestCommand& request = arguments.request;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(std::string(command.word), std::string(command.summary));
    sub->add_option("request", request.request, "File of the request, - for the standard input")
        ->capture_default_str();
    sub->add_option("-o,--output", request.output, "File of the answer instead of the standard output");
    sub->add_flag("-q,--quiet", request.quiet, "Show no progress on a terminal");
    if (command.word == word) {  // the flags of others would read the environment, too
      add_workers_flag(*sub, request.workers);
      add_limit_flags(*sub, request.limits);
    }
    if (command.word != "plan") continue;
    sub->add_option("--svg", request.svg, "File of a picture of the plan, SVG");
    sub->add_option("--png", request.png, "File of a picture of the plan, PNG");
  }
  CLI::App* map = app.add_subcommand(
      "map2request", "Make a request from a map of ROS and a table of robots, or from a MovingAI scenario");
  map->add_option("map", arguments.map, "File map.yaml of ROS, beside its image, or .map of MovingAI")
      ->required();
  CLI::Option* robots =
      map->add_option("--robots", arguments.robots, "With a map.yaml: table of the robots, CSV");
  CLI::Option* scenario =
      map->add_option("--scenario", arguments.scenario, "With a .map: file .scen of starts and goals");
  scenario->excludes(robots);
  ScenarioFleet& fleet = arguments.fleet;
  const auto add_number = [&](const char* flag, auto& number, const char* text) {
    map->add_option(flag, number, text)->needs(scenario)->check(CLI::PositiveNumber)->capture_default_str();
  };
  add_number("--count", fleet.count, "The most robots of a scenario");
  add_number("--radius", fleet.radius, "Their radius, metres");
  add_number("--linear-speed", fleet.linear_speed, "Their linear speed, m/s");
  add_number("--angular-speed", fleet.angular_speed, "Their angular speed, rad/s");
  map->add_option("-o,--output", request.output, "File of the request instead of the standard output");
  if (word == "map2request") add_limit_flags(*map, request.limits);
  app.add_subcommand("examples", "List the example requests, or print one")
      ->add_option("name", arguments.example, "Name of the example");
  app.add_subcommand("serve", "Serve over HTTP, as without a command: fleetplan serve --help");
}

}  // namespace

std::optional<int> run_command(std::vector<std::string> arguments,
                               const std::function<Service()>& make_service, const Streams& streams) {
  if (arguments.empty() || arguments[0].starts_with('-') || arguments[0] == "serve") return std::nullopt;
  const std::string word = arguments[0];
  const auto command = std::find_if(kCommands.begin(), kCommands.end(),
                                    [&](const Command& known) { return known.word == word; });
  if (command == kCommands.end() && word != "map2request" && word != "examples" && word != "help") {
    return fail(streams, kBadInput, "unknown command " + word + "; `fleetplan help` lists them");
  }
  if (word == "help") arguments = {"--help"};
  CLI::App app("Fleetplan: collision-free timed motions for fleets of robots.", "fleetplan");
  app.footer(
      "Without a command, or with `serve`, it serves over HTTP.\nExit codes: 0 solved or valid, 2 partial or "
      "not valid, 3 no robot has a plan, 64 bad input,\n1 anything else.");
  Arguments parsed;
  add_commands(app, word, parsed);
  std::reverse(arguments.begin(), arguments.end());  // the order that CLI11 expects
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    const int code = app.exit(error, text, text);
    (code == 0 ? streams.out : streams.err) << api::printable(text.str(), api::Lines::kept);
    return code == 0 ? kSolved : kBadInput;
  }
  if (word == "examples") return show_examples(parsed.example, make_service(), streams);
  RequestCommand& request = parsed.request;
  const CLI::App& sub = *app.get_subcommand(word);
  auto fault = ignored_environment(sub);
  if (!fault) fault = settle_limits(sub, request.limits);
  if (fault) return fail(streams, kBadInput, *fault);
  if (word == "map2request" && !parsed.scenario.empty()) {
    return scenario_to_request(parsed.map, parsed.scenario, parsed.fleet, request.output, request.limits,
                               streams);
  }
  if (word == "map2request") {
    if (parsed.robots.empty()) {
      return fail(streams, kBadInput,
                  "map2request needs --robots (of a map of ROS) or --scenario (of MovingAI)");
    }
    return map_to_request(parsed.map, parsed.robots, request.output, request.limits, streams);
  }
  request.endpoint = make_service().*command->endpoint;
  return answer_request(request, streams);
}

namespace {

/// The time for the probe: shorter than a container engine waits for its check, so that its report contains
/// the fault.
constexpr std::chrono::seconds kPatience{4};

/// Returns the address to probe. A service on all addresses is reachable by the loopback.
std::string probed_address(const std::string& host) {
  if (host == "0.0.0.0") return "127.0.0.1";
  if (host == "::") return "::1";
  return host;
}

}  // namespace

std::optional<std::string> health_fault(const Settings& settings) {
  const int port = settings.admin_port.value_or(settings.port);
  if (port == 0) return "--healthcheck cannot use port 0; name one";
  const std::string host = probed_address(settings.host);
  const std::string where = host + " port " + std::to_string(port);
  httplib::Client client(host, port);
  client.set_connection_timeout(kPatience);
  client.set_read_timeout(kPatience);
  const auto answer = client.Get("/healthz");
  if (!answer) return "no answer from " + where + ": " + httplib::to_string(answer.error());
  if (answer->status != 200) return where + " answered /healthz with " + std::to_string(answer->status);
  return std::nullopt;
}

}  // namespace fleetplan::server
