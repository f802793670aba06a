#include "server/command/answer_request.h"

#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "api/response/draw_plan.h"
#include "core/runtime/stop_condition.h"
#include "server/command/files.h"

namespace fleetplan::server {

namespace {

using Json = nlohmann::json;

/// For one picture: more than the largest maps and plans take.
constexpr std::chrono::seconds kMostForPicture{20};

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

/// A refusal as lines for people: "robots.json: /robots/0/start: the disk overlaps a blocked cell".
std::string in_lines(const api::Reply& reply, const std::string& request) {
  const Json problem = Json::parse(reply.body);
  const std::string file = shown_name(request);
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

/// The pictures that a command asks for, of the plan that is answered.
class Pictures {
 public:
  explicit Pictures(const RequestCommand& command) : command_(command) {}

  void draw(const core::Problem& problem, const core::Plan& plan) {
    using Clock = std::chrono::steady_clock;
    if (!command_.svg.empty()) {
      svg_ = api::draw_plan(problem, plan, core::StopCondition(Clock::now() + kMostForPicture));
    }
    if (!command_.png.empty()) {
      png_ = api::paint_plan(problem, plan, core::StopCondition(Clock::now() + kMostForPicture));
    }
  }

  /// The first file that could not be written, if any.
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

}  // namespace

int answer_request(const RequestCommand& command, const Streams& streams) {
  const auto body = read_file(command.request, streams.in);
  if (!body) return fail(streams, kBadInput, body.failure().line);
  Pictures pictures(command);
  api::RequestContext context;
  context.request_id = "command-line";
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

}  // namespace fleetplan::server
