#include "server/command/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <string_view>

#include "server/command/answer_request.h"
#include "server/command/files.h"
#include "server/command/map2request/map_to_request.h"

namespace fleetplan::server {

namespace {

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
  RequestCommand request;
  std::string example;
  std::string map;
  std::string robots;
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

void add_commands(CLI::App& app, Arguments& arguments) {
  RequestCommand& request = arguments.request;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(std::string(command.word), std::string(command.summary));
    sub->add_option("request", request.request, "File of the request, - for the standard input")
        ->capture_default_str();
    sub->add_option("-o,--output", request.output, "File of the answer instead of the standard output");
    sub->add_flag("-q,--quiet", request.quiet, "Show no progress on a terminal");
    if (command.word != "plan") continue;
    sub->add_option("--svg", request.svg, "File of a picture of the plan, SVG");
    sub->add_option("--png", request.png, "File of a picture of the plan, PNG");
  }
  CLI::App* map =
      app.add_subcommand("map2request", "Make a request from a map.yaml of ROS and a table of robots");
  map->add_option("map", arguments.map, "File map.yaml, beside its image")->required();
  map->add_option("--robots", arguments.robots, "Table of the robots, CSV")->required();
  map->add_option("-o,--output", request.output, "File of the request instead of the standard output");
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
  add_commands(app, parsed);
  std::reverse(arguments.begin(), arguments.end());  // the order that CLI11 expects
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error, streams.out, streams.err);
    return code == 0 ? kSolved : kBadInput;
  }
  if (word == "examples") return show_examples(parsed.example, make_service(), streams);
  if (word == "map2request") return map_to_request(parsed.map, parsed.robots, parsed.request.output, streams);
  parsed.request.endpoint = make_service().*command->endpoint;
  return answer_request(parsed.request, streams);
}

}  // namespace fleetplan::server
