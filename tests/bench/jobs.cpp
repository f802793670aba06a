#include "tests/bench/jobs.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tests/bench/workload.h"

namespace fleetplan::bench {
namespace {

namespace fs = std::filesystem;

/// The numbers of robots that the reference has of a file, or those asked for.
std::vector<std::size_t> robots_of(const std::string& file, const Options& options,
                                   const std::vector<Result>& reference) {
  if (!options.robots.empty()) return options.robots;
  std::vector<std::size_t> robots;
  for (const Result& result : reference) {
    if (result.file == file) robots.push_back(result.robots);
  }
  return robots;
}

/// Its path as the reference would name it, or as it was given where it is not below the root.
std::string name_of(const fs::path& file, const Options& options) {
  if (options.reference.empty()) return file.generic_string();
  const fs::path relative = fs::relative(file, options.root);
  return relative.empty() || *relative.begin() == ".." ? file.generic_string() : relative.generic_string();
}

Job file_job(const std::string& name, const fs::path& file, std::vector<std::size_t> robots) {
  return {name, [name, file] { return read_instance(name, file); }, std::move(robots)};
}

Job workload_job(const std::string& name, std::vector<std::size_t> robots) {
  return {name, [name] { return named_workload(name).value(); }, std::move(robots)};
}

std::vector<Job> reference_jobs(const Options& options, const std::vector<Result>& reference) {
  std::vector<Job> jobs;
  for (const Result& result : reference) {
    const auto known = [&](const Job& job) { return job.name == result.file; };
    if (std::any_of(jobs.begin(), jobs.end(), known)) continue;
    const auto robots = robots_of(result.file, options, reference);
    const fs::path file = fs::path(options.root) / result.file;
    if (fs::exists(file)) {
      jobs.push_back(file_job(result.file, file, robots));
    } else if (named_workload(result.file)) {
      jobs.push_back(workload_job(result.file, robots));
    } else {
      throw std::runtime_error("there is no " + file.string() + ", which the reference names");
    }
  }
  return jobs;
}

}  // namespace

std::string workload_name(const std::string& hall, std::uint64_t seed) {
  return hall + "/" + std::to_string(seed);
}

std::optional<Instance> named_workload(const std::string& name) {
  for (const Recipe& recipe : {empty_hall(), hall_with_rectangles()}) {
    if (!name.starts_with(recipe.name + "/")) continue;
    const auto seed = parse_numbers(name.substr(recipe.name.size() + 1));
    if (seed && seed->size() == 1) return make_instance(name, generate(recipe, seed->front()));
  }
  return std::nullopt;
}

std::vector<Job> jobs_of(const Options& options, const std::vector<Result>& reference) {
  std::vector<Job> jobs;
  if (!options.inputs.empty()) {
    for (const fs::path& file : request_files(options.inputs)) {
      const std::string name = name_of(file, options);
      jobs.push_back(file_job(name, file, robots_of(name, options, reference)));
    }
    return jobs;
  }
  if (!options.reference.empty()) return reference_jobs(options, reference);
  for (const std::uint64_t seed : options.seeds) {
    for (const std::string& hall : options.halls)
      jobs.push_back(workload_job(workload_name(hall, seed), options.robots));
  }
  return jobs;
}

}  // namespace fleetplan::bench
