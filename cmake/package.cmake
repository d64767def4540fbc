# `make deb`: Debian packages of what cmake --install gives, by CPack. Beside it each package has what Debian asks of one.
set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(packages library libduoptic${soversion} development libduoptic-dev tool duoptic python python3-duoptic)

# Duoptic has no mailbox: "invalid" is the domain that there will never be (RFC 2606).
set(DUO_MAINTAINER "The Duoptic authors <authors@duoptic.invalid>" CACHE STRING "Who answers for the Debian packages: Name <address>")

if(DUO_TOOL AND DUO_VIEWER)
  set(metainfo invalid.duoptic.Duoptic.metainfo.xml)
  configure_file(packaging/${metainfo}.in ${PROJECT_BINARY_DIR}/packaging/${metainfo} @ONLY)
  install(FILES packaging/duoptic.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT tool)
  install(FILES packaging/duoptic.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT tool)
  install(FILES ${PROJECT_BINARY_DIR}/packaging/${metainfo} DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT tool)
endif()

# Where the packages are built the folders of documents and the scripts are theirs, too.
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  return()
endif()
set(made ${PROJECT_BINARY_DIR}/packaging)
configure_file(packaging/changelog.in ${made}/changelog @ONLY)
execute_process(COMMAND gzip -9nf ${made}/changelog COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${made}/library/shlibs "libduoptic ${soversion} libduoptic${soversion} (>= ${PROJECT_VERSION})\n")
file(WRITE ${made}/library/triggers "activate-noawait ldconfig\n")
foreach(script postinst prerm)
  configure_file(packaging/python.${script} ${made}/python/${script} COPYONLY FILE_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
endforeach()

if(TARGET duoptic_manual)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/man/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT tool)
  install(FILES ${PROJECT_BINARY_DIR}/completions/duoptic DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT tool)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME duoptic)
set(CPACK_PACKAGE_VENDOR "The Duoptic authors")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${DUO_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)  # no package has our own library yet

set(this_library "libduoptic${soversion} (= ${PROJECT_VERSION})")
# CPack indents what follows the first line.
set(duoptic "Duoptic turns the pictures of two ordinary webcams into disparity, depth in
millimetres, coloured points, and 21 joints of each person in metres.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${made}/library/shlibs;${made}/library/triggers")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "depth and people in 3D from two webcams - library
${duoptic}

This package has the library, and the networks that find people.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "mesa-vulkan-drivers")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ${this_library})
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "depth and people in 3D from two webcams - headers
${duoptic}

This package has what C++ programs are built with: headers, CMake and
pkg-config files.")

set(CPACK_DEBIAN_TOOL_PACKAGE_SECTION video)
set(CPACK_DEBIAN_TOOL_PACKAGE_DEPENDS "${this_library}, libgl1")
set(CPACK_DEBIAN_TOOL_PACKAGE_RECOMMENDS "libgl1-mesa-dri")
set(CPACK_DEBIAN_TOOL_DESCRIPTION "two webcams as a depth camera and 3D tracker of people
${duoptic}
It calibrates the cameras, records them, and hands motion on to other
programs.

This package has the command-line tool and its window.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${this_library}, python3 (>= ${DUO_PYTHON_VERSION}), python3 (<< ${DUO_PYTHON_NEXT_VERSION}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${made}/python/postinst;${made}/python/prerm")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "depth and people in 3D from two webcams - Python module
${duoptic}

This package has the module duoptic: frames as numpy arrays without copies.")

set(CPACK_COMPONENTS_ALL library development)
if(DUO_TOOL)
  list(APPEND CPACK_COMPONENTS_ALL tool)
endif()
if(DUO_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
while(packages)
  list(POP_FRONT packages component name)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  install(FILES packaging/copyright NOTICE ${made}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endwhile()
include(CPack)
