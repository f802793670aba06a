// generate_openapi FILE: writes the generated parts of the OpenAPI document anew.

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "api/openapi/generated_parts.h"

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: generate_openapi FILE");
  std::ifstream in(argv[1]);
  const std::string document{std::istreambuf_iterator<char>(in), {}};
  const std::string updated = fleetplan::api::with_generated_parts(document);
  std::ofstream out(argv[1]);
  out << updated;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + std::string(argv[1]));
  return 0;
} catch (const std::exception& error) {
  std::fputs((std::string(error.what()) + '\n').c_str(), stderr);
  return 1;
}
