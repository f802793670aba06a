// Runs the target for builds without libFuzzer:
//
//   fuzz_NAME FOLDER...              every file of the folders, so that inputs found once remain tests
//   fuzz_NAME --random SEED RUNS     so many random inputs; the same for a seed
//   fuzz_NAME --random SEED RUNS N   input number N of them only, counted from 0

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

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

int run_random(std::uint64_t seed, std::uint64_t first, std::uint64_t end) {
  for (std::uint64_t number = first; number < end; ++number) {
    std::cout << "input " << number << std::endl;  // flushed: the last number is the failure
    const auto input = random_input(seed, number);
    LLVMFuzzerTestOneInput(input.data(), input.size());
  }
  return end > first ? 0 : 1;
}

int run_files(const std::vector<std::string>& folders) {
  int tried = 0;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string input{std::istreambuf_iterator<char>(file), {}};
      std::cout << entry.path().filename().string() << std::endl;  // flushed: the last name is the failure
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
      ++tried;
    }
  }
  std::cout << tried << " inputs\n";
  return tried > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 3 || arguments[0] != "--random") return run_files(arguments);
  const std::uint64_t seed = std::stoull(arguments[1]);
  const std::uint64_t runs = std::stoull(arguments[2]);
  if (arguments.size() == 3) return run_random(seed, 0, runs);
  const std::uint64_t number = std::stoull(arguments[3]);
  return run_random(seed, number, number + 1);
}
