# Debian packages: `cpack -G DEB` in the folder of a build writes fleetplan, the server with its page, a unit of
# systemd, a manual page and examples, and libfleetplan-dev, the libraries with their headers. Prepare the build with
# CMAKE_INSTALL_PREFIX=/usr; docs/operations.md has the commands.
#
# The components are `runtime`, which is also what an image consists of, `system` and `development`.

set(doc ${CMAKE_INSTALL_DATAROOTDIR}/doc)
set(debian ${PROJECT_SOURCE_DIR}/deploy/debian)

# install_compressed FILE FOLDER NAME COMPONENT: installs a file as FOLDER/NAME.gz.
function(install_compressed file folder name component)
  install(CODE "
    set(packed \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}/${name}.gz\")
    file(MAKE_DIRECTORY \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}\")
    execute_process(COMMAND gzip -9nc \"${file}\" OUTPUT_FILE \"\${packed}\" COMMAND_ERROR_IS_FATAL ANY)
    " COMPONENT ${component})
endfunction()

install(FILES ${debian}/fleetplan.service DESTINATION lib/systemd/system COMPONENT system EXCLUDE_FROM_ALL)
install(FILES ${debian}/fleetplan.default DESTINATION /etc/default RENAME fleetplan COMPONENT system EXCLUDE_FROM_ALL)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${doc}/fleetplan RENAME copyright COMPONENT system)
install(FILES ${PROJECT_SOURCE_DIR}/NOTICE DESTINATION ${doc}/fleetplan COMPONENT system)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${doc}/fleetplan COMPONENT system
        USE_SOURCE_PERMISSIONS PATTERN __pycache__ EXCLUDE)
install_compressed(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${doc}/fleetplan changelog system)
install_compressed(${PROJECT_SOURCE_DIR}/docs/fleetplan.1 ${CMAKE_INSTALL_DATAROOTDIR}/man/man1 fleetplan.1 system)

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${doc}/libfleetplan-dev RENAME copyright
        COMPONENT development)
install_compressed(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${doc}/libfleetplan-dev changelog development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fleetplan)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Fleetplan maintainers <maintainers@fleetplan.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime system development)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)

set(CPACK_DEBIAN_SERVER_PACKAGE_NAME fleetplan)
set(CPACK_DEBIAN_SERVER_PACKAGE_SECTION net)
set(CPACK_DEBIAN_SERVER_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS "init-system-helpers (>= 1.54)")
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS "libfleetplan-dev")
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA
    "${debian}/postinst;${debian}/prerm;${debian}/postrm;${debian}/conffiles")
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_STRICT_PERMISSION ON)

string(CONCAT CPACK_DEBIAN_SERVER_DESCRIPTION
    "A stateless HTTP service that plans timed motions for fleets of differential-drive\n"
    "robots, its web page, and commands that answer requests from files.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libfleetplan-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libstdc++-12-dev | libstdc++-13-dev | libstdc++-14-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS libpng-dev)  # for fleetplan::service only
string(CONCAT CPACK_DEBIAN_DEV_DESCRIPTION
    "Headers, static libraries and CMake package for programs that plan timed motions for\n"
    "fleets of differential-drive robots, or answer what the service answers:\n"
    "find_package(fleetplan).")

include(CPack)
cpack_add_component_group(server)
cpack_add_component_group(dev)
cpack_add_component(runtime GROUP server)
cpack_add_component(system GROUP server)
cpack_add_component(development GROUP dev)
