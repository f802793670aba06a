# Writes a .cpp with the OpenAPI document as a char array, without line breaks and indents.
# Usage: cmake -DDOCUMENT=... -DOUTPUT=... -P embed_openapi.cmake

cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/char_array.cmake)

file(READ "${DOCUMENT}" document)
string(REGEX REPLACE "\n *" "" document "${document}")
string(HEX "${document}" hex)
char_array(kDocument "${hex}" array)
file(WRITE "${OUTPUT}" "// Made by api/embed_openapi.cmake from api/openapi.json; do not edit.
#include \"api/endpoints/endpoints.h\"

namespace fleetplan::api {
namespace {
${array}}  // namespace

std::string_view openapi_document() { return {kDocument, sizeof(kDocument)}; }
}  // namespace fleetplan::api
")
