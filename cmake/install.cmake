# `cmake --install`: the library with its headers, so that find_package(percale) finds it, and the
# program with the files that it reads.
option(PERCALE_INSTALL "Install the library and the program" ${PROJECT_IS_TOP_LEVEL})
if(NOT PERCALE_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS percale EXPORT percaleTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(DIRECTORY include/percale DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library FILES_MATCHING PATTERN "*.h")
install(EXPORT percaleTargets NAMESPACE percale::
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/percale COMPONENT library)

# A static library hands what it links to on to its user, so the user has to find it as well.
get_target_property(PERCALE_LINKS percale LINK_LIBRARIES)
set(PERCALE_DEPENDENCIES "")
if("TBB::tbb" IN_LIST PERCALE_LINKS)
  string(APPEND PERCALE_DEPENDENCIES "find_dependency(TBB)\n")
endif()
if("Threads::Threads" IN_LIST PERCALE_LINKS)
  string(APPEND PERCALE_DEPENDENCIES "find_dependency(Threads)\n")
endif()
configure_package_config_file(cmake/percaleConfig.cmake.in ${PROJECT_BINARY_DIR}/percaleConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/percale)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/percaleConfigVersion.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/percaleConfig.cmake ${PROJECT_BINARY_DIR}/percaleConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/percale COMPONENT library)

if(TARGET percale_program)
  install(TARGETS percale_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(DIRECTORY presets scene shaders textures DESTINATION ${CMAKE_INSTALL_DATADIR}/percale COMPONENT program
    PATTERN "*.py" EXCLUDE PATTERN "__pycache__" EXCLUDE)
endif()
