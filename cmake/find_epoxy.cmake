# epoxy::epoxy, the loader of OpenGL functions. Debian and vcpkg ship it with a pkg-config file and
# without a CMake one, and Windows has no pkg-config: look for the header and the library.
if(NOT TARGET epoxy::epoxy)
  find_path(EPOXY_INCLUDE_DIR epoxy/gl.h)
  find_library(EPOXY_LIBRARY NAMES epoxy epoxy_0)
  mark_as_advanced(EPOXY_INCLUDE_DIR EPOXY_LIBRARY)
  if(NOT EPOXY_INCLUDE_DIR OR NOT EPOXY_LIBRARY)
    message(FATAL_ERROR "percale: libepoxy was not found; the renderer needs it "
      "(Debian: libepoxy-dev, Homebrew and vcpkg: libepoxy), or build without: -DPERCALE_BUILD_RENDER=OFF -DPERCALE_BUILD_APPS=OFF")
  endif()
  add_library(epoxy::epoxy UNKNOWN IMPORTED GLOBAL)
  set_target_properties(epoxy::epoxy PROPERTIES
    IMPORTED_LOCATION "${EPOXY_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${EPOXY_INCLUDE_DIR}")
endif()
