// Runs targets in builds without libFuzzer. PROGRAM is fuzz_replay, or the program of one target:
//
//   PROGRAM TARGET FOLDER...              every file of the folders, so that inputs found once remain tests
//   PROGRAM TARGET --random SEED RUNS     so many random inputs; the same for a seed
//   PROGRAM TARGET --random SEED RUNS N   input number N of them only, counted from 0

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

namespace fleetplan::fuzz {

namespace {

constexpr std::size_t kLongestInput = 160;

/// Bytes whose upper half is small or large more often than in between: the ends of the ranges.
std::vector<std::uint8_t> random_input(std::uint64_t seed, std::uint64_t number) {
  std::mt19937_64 random(seed * 1'000'003 + number);
  std::vector<std::uint8_t> bytes(random() % kLongestInput);
  for (std::uint8_t& byte : bytes) {
    const std::uint64_t drawn = random();
    const std::uint64_t kind = drawn % 4;
    byte = static_cast<std::uint8_t>((drawn >> 8U) % (kind == 0 ? 256 : 64));
    if (kind == 1) byte = static_cast<std::uint8_t>(255 - byte);
  }
  return bytes;
}

int run_random(Run run, std::uint64_t seed, std::uint64_t first, std::uint64_t end) {
  for (std::uint64_t number = first; number < end; ++number) {
    std::cout << "input " << number << std::endl;  // flushed: the last number is the failure
    run(random_input(seed, number));
  }
  return end > first ? 0 : 1;
}

int run_files(Run run, const std::vector<std::string>& folders) {
  int tried = 0;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::vector<std::uint8_t> input{std::istreambuf_iterator<char>(file), {}};
      std::cout << entry.path().filename().string() << std::endl;  // flushed: the last name is the failure
      run(input);
      ++tried;
    }
  }
  std::cout << tried << " inputs\n";
  return tried > 0 ? 0 : 1;
}

int run_as_told(Run run, const std::vector<std::string>& how) {
  if (how.size() < 3 || how[0] != "--random") return run_files(run, how);
  const std::uint64_t seed = std::stoull(how[1]);
  const std::uint64_t runs = std::stoull(how[2]);
  if (how.size() == 3) return run_random(run, seed, 0, runs);
  const std::uint64_t number = std::stoull(how[3]);
  return run_random(run, seed, number, number + 1);
}

}  // namespace

}  // namespace fleetplan::fuzz

int main(int argc, char** argv) {
  using namespace fleetplan::fuzz;
  const auto found = targets().find(argc > 1 ? argv[1] : "");
  if (found != targets().end()) return run_as_told(found->second, {argv + 2, argv + argc});
  std::cerr << "the first argument is none of the targets:";
  for (const auto& [name, run] : targets()) std::cerr << ' ' << name;
  std::cerr << '\n';
  return 64;
}
