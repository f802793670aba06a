#include "server/command/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "api/endpoints/plan_endpoint.h"
#include "api/response/draw_plan.h"
#include "server/ops/version.h"

namespace fleetplan::server {

namespace {

using Json = nlohmann::json;

struct Command {
  std::string_view word;
  std::string_view summary;
  Service::Endpoint Service::*endpoint;
};

constexpr std::array<Command, 7> kCommands{{
    {"plan", "Plan the motions of all robots", &Service::plan},
    {"validate", "Check plans: exit code 2 if they are not valid", &Service::validate},
    {"simulate", "Execute plans many times with disturbances", &Service::simulate},
    {"advance", "Move a request to a later moment of its plans", &Service::advance},
    {"dependencies", "List what robots must wait for in a plan", &Service::dependencies},
    {"retime", "Give a plan new times after delays", &Service::retime},
    {"export-vda5050", "Turn plans into orders of VDA 5050", &Service::vda5050},
}};

/// What the arguments of a command say.
struct Arguments {
  std::string request = "-";
  std::string output;
  std::string svg;
  std::string example;
  bool quiet = false;
};

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

/// All of a file, or of the standard input for "-"; nothing if it cannot be read.
std::optional<std::string> read_all(const std::string& name, std::istream& in) {
  std::ifstream file;
  if (name != "-") file.open(name, std::ios::binary);
  std::istream& source = name == "-" ? in : file;
  std::ostringstream text;
  if (!source || !(text << source.rdbuf())) return source.eof() ? std::optional("") : std::nullopt;
  return text.str();
}

bool write_all(const std::string& name, const std::string& text) {
  std::ofstream file(name, std::ios::binary);
  file << text;
  file.close();
  return !file.fail();
}

/// A refusal as lines for people: "robots.json: /robots/0/start: the disk overlaps a blocked cell".
std::string in_lines(const api::Reply& reply, const std::string& request) {
  const Json problem = Json::parse(reply.body);
  const std::string file = request == "-" ? "stdin" : request;
  const auto faults = problem.value("errors", Json::array());
  if (faults.empty()) return file + ": " + problem.value("detail", "") + '\n';
  std::string lines;
  for (const Json& fault : faults) {
    lines += file + ": " + fault.value("pointer", "") + ": " + fault.value("detail", "") + '\n';
  }
  const std::size_t total = problem.value("errors_total", faults.size());
  if (total > faults.size())
    lines += file + ": and " + std::to_string(total - faults.size()) + " more faults\n";
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
  return answer.value("valid", true) ? kSolved : kPartial;
}

/// Answers the request. `picture` gets an SVG picture of the plan, if there is one, unless null.
api::Reply answer(const Command& command, const Service& service, const std::string& body,
                  const api::RequestContext& context, std::string* picture) {
  if (picture == nullptr) return (service.*command.endpoint)(body, context);
  const auto planner = [&](const core::Problem& problem, const core::PlanOptions& options,
                           const core::StopCondition& stop, core::Observer* observer) {
    core::CallerThread thread;
    core::Plan plan = core::plan(problem, options, stop, thread, observer);
    *picture = api::draw_plan(problem, plan);
    return plan;
  };
  return api::plan_with(planner, body, context);
}

int fail(std::ostream& err, int code, const std::string& message) {
  err << "fleetplan: " << message << '\n';
  return code;
}

int run(const Command& command, const Arguments& arguments, const Service& service, Streams& streams) {
  const auto body = read_all(arguments.request, streams.in);
  if (!body) return fail(streams.err, kBadInput, "cannot read " + arguments.request);
  api::RequestContext context;
  context.request_id = "command-line";
  std::string picture;
  api::Reply reply;
  {
    std::optional<TerminalProgress> progress;
    if (streams.shows_progress && !arguments.quiet) progress.emplace(streams.err);
    if (progress) context.events = &*progress;
    reply = answer(command, service, *body, context, arguments.svg.empty() ? nullptr : &picture);
  }
  const int code = exit_code_of(reply);
  if (reply.status != 200) {
    streams.err << in_lines(reply, arguments.request);
    return code;
  }
  if (!reply.body.ends_with('\n')) reply.body += '\n';
  if (arguments.output.empty()) {
    streams.out << reply.body << std::flush;
  } else if (!write_all(arguments.output, reply.body)) {
    return fail(streams.err, kFailed, "cannot write " + arguments.output);
  }
  if (!arguments.svg.empty() && !write_all(arguments.svg, picture)) {
    return fail(streams.err, kFailed, "cannot write " + arguments.svg);
  }
  return code;
}

int show_examples(const std::string& name, const Service& service, Streams& streams) {
  if (name.empty()) {
    for (const auto& example : service.examples) streams.out << example.name << '\n';
    return kSolved;
  }
  const auto& examples = service.examples;
  const auto found = std::find_if(examples.begin(), examples.end(),
                                  [&](const Service::Example& example) { return example.name == name; });
  if (found == examples.end()) {
    return fail(streams.err, kBadInput, "there is no example " + name + "; `fleetplan examples` lists them");
  }
  streams.out << found->body;
  return kSolved;
}

void add_commands(CLI::App& app, Arguments& arguments) {
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(std::string(command.word), std::string(command.summary));
    sub->add_option("request", arguments.request, "File of the request, - for the standard input")
        ->capture_default_str();
    sub->add_option("-o,--output", arguments.output, "File of the answer instead of the standard output");
    sub->add_flag("-q,--quiet", arguments.quiet, "Show no progress on a terminal");
    if (command.word == "plan") sub->add_option("--svg", arguments.svg, "File of a picture of the plan");
  }
  app.add_subcommand("examples", "List the example requests, or print one")
      ->add_option("name", arguments.example, "Name of the example");
  app.add_subcommand("serve", "Serve over HTTP, as without a command: fleetplan serve --help");
}

}  // namespace

std::optional<int> run_command(std::vector<std::string> arguments, const Service& service, Streams streams) {
  if (arguments.empty() || arguments[0].starts_with('-') || arguments[0] == "serve") return std::nullopt;
  const std::string word = arguments[0];
  const auto command = std::find_if(kCommands.begin(), kCommands.end(),
                                    [&](const Command& known) { return known.word == word; });
  if (command == kCommands.end() && word != "examples" && word != "help") {
    return fail(streams.err, kBadInput, "unknown command " + word + "; `fleetplan help` lists them");
  }
  if (word == "help") arguments = {"--help"};
  CLI::App app("Fleetplan: collision-free timed motions for fleets of robots.", "fleetplan");
  app.footer(
      "Without a command, or with `serve`, it serves over HTTP.\nExit codes: 0 solved or valid, 2 partial or "
      "not valid, 3 no robot has a plan, 64 bad input,\n1 anything else.");
  Arguments parsed;
  add_commands(app, parsed);
  std::reverse(arguments.begin(), arguments.end());  // the order that CLI11 expects
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error, streams.out, streams.err);
    return code == 0 ? kSolved : kBadInput;
  }
  if (word == "examples") return show_examples(parsed.example, service, streams);
  return run(*command, parsed, service, streams);
}

}  // namespace fleetplan::server
