# Writes a .cpp with the OpenAPI document as a byte array. It is joined from its parts: a string "@FILE@" stands
# for that file's content, of FOLDER, or of SCENARIOS where it begins with "scenarios/"; @VERSION@ in a string stands
# for the version. Line breaks and indents are left out.
# Usage: cmake -DFOLDER=... -DSCENARIOS=... -DVERSION=... -DOUTPUT=... -P embed_openapi.cmake

cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/char_array.cmake)

file(READ "${FOLDER}/document.json" document)
while(document MATCHES "\"@([a-z_]+/)?([a-z_-]+\\.json)@\"")
  set(reference "${CMAKE_MATCH_0}")
  set(file "${FOLDER}/${CMAKE_MATCH_1}${CMAKE_MATCH_2}")
  if(CMAKE_MATCH_1 STREQUAL "scenarios/")
    set(file "${SCENARIOS}/${CMAKE_MATCH_2}")
  endif()
  file(READ "${file}" part)
  string(REPLACE "${reference}" "${part}" document "${document}")
endwhile()
string(REPLACE "@VERSION@" "${VERSION}" document "${document}")
string(REGEX REPLACE "\n *" "" document "${document}")

string(HEX "${document}" hex)
char_array(kDocument "${hex}" array)
file(WRITE "${OUTPUT}" "// Made by api/embed_openapi.cmake from api/openapi; do not edit.
#include \"api/endpoints/openapi.h\"

namespace fleetplan::api {
namespace {
${array}}  // namespace

std::string_view openapi_document() { return {kDocument, sizeof(kDocument)}; }
}  // namespace fleetplan::api
")
