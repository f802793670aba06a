// Benchmarks of the planner; see --help, or scripts/bench, which builds and runs this.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>

#include "tests/bench/comparison.h"
#include "tests/bench/jobs.h"
#include "tests/bench/markdown.h"
#include "tests/bench/measure.h"
#include "tests/bench/options.h"
#include "tests/bench/paper_claims.h"
#include "tests/bench/report.h"
#include "tests/bench/result_table.h"
#include "tests/bench/scaling.h"

namespace fleetplan::bench {
namespace {

std::ofstream open_output(const std::string& file) {
  const auto folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::ofstream stream(file);
  if (!stream) throw std::runtime_error("cannot write " + file);
  return stream;
}

std::vector<Result> read_reference(const std::string& file) {
  if (file.empty()) return {};
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file);
  try {
    return read_results(stream);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file + ", " + error.what());
  }
}

/// Runs bodies, keeps what came out, and tells how it goes on stderr.
class Bench {
 public:
  explicit Bench(const Options& options) : options_(options) {
    if (options.csv.empty()) return;
    csv_ = open_output(options.csv);
    csv_ << csv_header() << std::flush;
  }

  Measurement run(const std::string& name, std::size_t robots, const std::string& body) {
    Measurement made = measure(name, robots, body, {options_.budget, options_.repeats});
    std::cerr << name << ", " << robots << " robots: " << seconds_text(made.result.seconds) << " s, "
              << made.planned << " planned\n";
    if (!made.fault.empty()) {
      std::cerr << "  FAULT: " << made.fault << '\n';
      ++faults_;
    }
    if (csv_.is_open()) csv_ << csv_row(made) << std::flush;
    runs_.push_back(made);
    return made;
  }

  void run(const Job& job) {
    const Instance instance = job.load();
    std::vector<std::size_t> counts = job.robots;
    if (counts.empty()) counts.push_back(instance.robots());
    for (const std::size_t robots : counts) {
      if (robots > instance.robots()) {
        std::cerr << job.name << " has only " << instance.robots() << " robots, not " << robots << '\n';
        continue;
      }
      run(job.name, robots, instance.body(robots, options_.planning));
    }
  }

  const std::vector<Measurement>& runs() const { return runs_; }
  std::size_t faults() const { return faults_; }

 private:
  const Options& options_;
  std::ofstream csv_;
  std::vector<Measurement> runs_;
  std::size_t faults_ = 0;
};

std::vector<HallSummary> halls_of(const std::vector<Measurement>& runs, const Options& options) {
  std::map<std::string, std::vector<Measurement>> by_hall;
  for (const Measurement& run : runs) {
    by_hall[run.result.file.substr(0, run.result.file.find('/'))].push_back(run);
  }
  std::vector<HallSummary> halls;
  for (const std::string& hall : options.halls) halls.push_back({hall, summarise(by_hall[hall])});
  return halls;
}

void report_halls(const std::vector<Measurement>& runs, const Options& options) {
  const std::vector<HallSummary> halls = halls_of(runs, options);
  for (const HallSummary& hall : halls) std::cout << hall_table(hall) << '\n';
  std::cout << kHallTableNotes << '\n' << kPaperClaims << '\n';
  if (options.svg.empty()) return;
  open_output(options.svg) << hall_chart(halls);
}

int run(const Options& options) {
  const std::vector<Result> reference = read_reference(options.reference);
  Bench bench(options);
  if (options.scaling) {
    const auto measure_body = [&](const std::string& name, std::size_t robots, const std::string& body) {
      return bench.run(name, robots, body);
    };
    std::cout << scaling_report(options, measure_body) << '\n';
  } else {
    for (const Job& job : jobs_of(options, reference)) bench.run(job);
    if (!options.reference.empty()) {
      std::cout << comparison_report(compare(bench.runs(), reference)) << '\n';
    } else if (!options.inputs.empty()) {
      std::cout << run_table(bench.runs()) << '\n';
    } else {
      report_halls(bench.runs(), options);
    }
  }
  std::cout << closing_lines(bench.runs());
  return bench.faults() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace fleetplan::bench

int main(int argc, char** argv) {
  using namespace fleetplan::bench;
  const auto parsed = parse_options({argv + 1, argv + argc});
  if (const auto* exit = std::get_if<Exit>(&parsed)) {
    (exit->code == 0 ? std::cout : std::cerr) << exit->text;
    return exit->code;
  }
  try {
    return run(std::get<Options>(parsed));
  } catch (const std::runtime_error& error) {
    std::cerr << "fleetplan_bench: " << error.what() << '\n';
    return 1;
  }
}
