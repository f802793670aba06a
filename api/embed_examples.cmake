# Writes a .cpp with the request files of a folder as byte arrays.
# Usage: cmake -DFOLDER=... -DOUTPUT=... -P embed_examples.cmake

cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/char_array.cmake)

# By name without the ending: "crossing" comes before "crossing-people".
file(GLOB files "${FOLDER}/*.json")
list(TRANSFORM files REPLACE "\\.json$" "")
list(SORT files)

set(arrays "")
set(table "")
set(index "{}")
set(count 0)
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME_WE)
  file(READ "${file}.json" bytes HEX)
  if(name STREQUAL "index")
    char_array(kIndex "${bytes}" array)
    set(index "{kIndex, sizeof(kIndex)}")
  else()
    char_array(kBody${count} "${bytes}" array)
    string(APPEND table "    Example{\"${name}\", {kBody${count}, sizeof(kBody${count})}},\n")
    math(EXPR count "${count} + 1")
  endif()
  string(APPEND arrays "${array}")
endforeach()

file(WRITE "${OUTPUT}" "// Made by api/embed_examples.cmake from the request files; do not edit.
#include \"api/endpoints/endpoints.h\"

#include <array>

namespace fleetplan::api {
namespace {
${arrays}
constexpr std::array<Example, ${count}> kExamples{
${table}};
}  // namespace

std::span<const Example> examples() { return kExamples; }
std::string_view examples_index() { return ${index}; }
}  // namespace fleetplan::api
")
