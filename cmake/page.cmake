# The page that the server sends by default: FLEETPLAN_WEB_ROOT is its folder. With esbuild it is a bundle of web/,
# a handful of files with content hashes in their names; without esbuild it is web/ itself.

find_program(FLEETPLAN_ESBUILD esbuild DOC "Bundler of the page; without it, the page is served from its sources")

set(page_source ${PROJECT_SOURCE_DIR}/web)
if(FLEETPLAN_ESBUILD)
  set(FLEETPLAN_WEB_ROOT ${PROJECT_BINARY_DIR}/web)
  file(GLOB_RECURSE page_files CONFIGURE_DEPENDS ${page_source}/*)
  add_custom_command(
    OUTPUT ${FLEETPLAN_WEB_ROOT}/index.html
    COMMAND ${CMAKE_COMMAND} -DESBUILD=${FLEETPLAN_ESBUILD} -DSOURCE=${page_source} -DOUTPUT=${FLEETPLAN_WEB_ROOT}
            -P ${CMAKE_CURRENT_LIST_DIR}/bundle_page.cmake
    DEPENDS ${page_files} ${CMAKE_CURRENT_LIST_DIR}/bundle_page.cmake
    COMMENT "Bundling the page"
    VERBATIM)
  add_custom_target(fleetplan_page ALL DEPENDS ${FLEETPLAN_WEB_ROOT}/index.html)
else()
  message(STATUS "esbuild is not installed: the page is served from its sources, as many small files")
  set(FLEETPLAN_WEB_ROOT ${page_source})
  add_custom_target(fleetplan_page)
endif()

install(DIRECTORY ${FLEETPLAN_WEB_ROOT}/ DESTINATION share/fleetplan/web COMPONENT runtime)
