# With CMAKE_UNITY_BUILD, the sources of a folder of these targets are compiled as one, which saves CPU time of a full
# build. Two sources of a folder then share their unnamed namespace. The one that uses names for other things than its
# folder is compiled on its own. Some folders are compiled with the folders in them, whose names differ.

set(alone server/.*/socket.cpp)
set(whole core/execution core/verify server/http server/ops)
list(JOIN whole "|" whole)

foreach(target fleetplan_core fleetplan_api fleetplan_server)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} OUTPUT_VARIABLE path)
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    if(name MATCHES "^(${alone})$")
      continue()  # a source without a group is compiled on its own
    endif()
    if(name MATCHES "^(${whole})/")
      set(group ${CMAKE_MATCH_1})
    else()
      cmake_path(GET name PARENT_PATH group)
    endif()
    string(MAKE_C_IDENTIFIER "${group}" group)
    set_property(SOURCE ${path} TARGET_DIRECTORY ${target} PROPERTY UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endforeach()

# CLI11 makes this folder take longest by far. Sources are compiled in the order of the list.
get_target_property(sources fleetplan_server SOURCES)
set(longest ${sources})
list(FILTER longest INCLUDE REGEX "^ops/")
list(REMOVE_ITEM sources ${longest})
set_target_properties(fleetplan_server PROPERTIES SOURCES "${longest};${sources}")
