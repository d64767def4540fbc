# cmake --install: the shared library with its headers, CMake and pkg-config files, the networks, the tool, the Python module.
include(CMakePackageConfigHelpers)

install(TARGETS duoptic_shared EXPORT DuopticTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(FILES models/LICENSE models/README.md models/body_full.net models/body_lite.net models/hand_full.net models/hand_lite.net models/person_detector.net
  DESTINATION ${DUO_MODELS_FOLDER} COMPONENT library)

install(DIRECTORY include/duoptic DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Duoptic)
install(EXPORT DuopticTargets NAMESPACE Duoptic:: DESTINATION ${config} COMPONENT development)
configure_package_config_file(cmake/DuopticConfig.cmake.in ${PROJECT_BINARY_DIR}/DuopticConfig.cmake INSTALL_DESTINATION ${config})
# Until version 1 every second number may change what a program sees.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/DuopticConfigVersion.cmake COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH prefix_from_pkgconfig /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(cmake/duoptic.pc.in ${PROJECT_BINARY_DIR}/duoptic.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/DuopticConfig.cmake ${PROJECT_BINARY_DIR}/DuopticConfigVersion.cmake
  DESTINATION ${config} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/duoptic.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(DUO_TOOL)
  install(TARGETS duoptic_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tool)
  # Where the system looks for libraries by itself, a path in the program would only be a second place.
  if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    file(RELATIVE_PATH libraries_from_tool /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
    set_target_properties(duoptic_tool PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries_from_tool}")
  endif()
endif()

if(DUO_PYTHON)
  # Debian's packages of modules lie where every Python 3 looks.
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(modules lib/python3/dist-packages)
  else()
    set(modules lib/python${DUO_PYTHON_VERSION}/site-packages)
    file(RELATIVE_PATH libraries_from_module /prefix/${modules}/duoptic /prefix/${CMAKE_INSTALL_LIBDIR})
    set_target_properties(duoptic_python PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries_from_module}")
  endif()
  install(TARGETS duoptic_python LIBRARY DESTINATION ${modules}/duoptic COMPONENT python)
  install(FILES python/duoptic/__init__.py python/duoptic/__init__.pyi python/duoptic/py.typed
    DESTINATION ${modules}/duoptic COMPONENT python)
endif()
