# imgui::imgui, Dear ImGui with its GLFW and OpenGL 3 back ends; include <imgui.h>,
# <imgui_impl_glfw.h> and <imgui_impl_opengl3.h>, wherever the package keeps them.
if(NOT TARGET imgui::imgui)
  find_package(imgui CONFIG QUIET)  # vcpkg
  if(TARGET imgui::imgui)
    set_target_properties(imgui::imgui PROPERTIES IMPORTED_GLOBAL TRUE)
  endif()
endif()
if(NOT TARGET imgui::imgui)
  find_path(IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui)
  find_path(IMGUI_BACKENDS_DIR imgui_impl_opengl3.h PATH_SUFFIXES imgui/backends imgui backends)
  find_library(IMGUI_LIBRARY imgui)
  find_library(IMGUI_STB_LIBRARY stb)  # Debian's static libimgui leaves these functions to libstb
  mark_as_advanced(IMGUI_INCLUDE_DIR IMGUI_BACKENDS_DIR IMGUI_LIBRARY IMGUI_STB_LIBRARY)
  if(NOT IMGUI_INCLUDE_DIR OR NOT IMGUI_BACKENDS_DIR OR NOT IMGUI_LIBRARY)
    message(FATAL_ERROR "percale: Dear ImGui was not found; the viewer needs it with its GLFW and OpenGL 3 back ends "
      "(Debian: libimgui-dev, vcpkg: imgui[glfw-binding,opengl3-binding]), or build without: -DPERCALE_BUILD_APPS=OFF")
  endif()
  find_package(glfw3 3.3 REQUIRED)
  add_library(imgui::imgui UNKNOWN IMPORTED GLOBAL)
  set_target_properties(imgui::imgui PROPERTIES
    IMPORTED_LOCATION "${IMGUI_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${IMGUI_INCLUDE_DIR};${IMGUI_BACKENDS_DIR}"
    INTERFACE_LINK_LIBRARIES "glfw;${CMAKE_DL_LIBS}")
  if(IMGUI_STB_LIBRARY)
    set_property(TARGET imgui::imgui APPEND PROPERTY INTERFACE_LINK_LIBRARIES "${IMGUI_STB_LIBRARY}")
  endif()
endif()
