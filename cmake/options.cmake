# Options of the build, and what every target of ours is compiled with.

option(PERCALE_BUILD_RENDER "Build the OpenGL renderer (needs epoxy, libpng, and EGL or GLFW)" ${PROJECT_IS_TOP_LEVEL})
option(PERCALE_BUILD_APPS "Build the program percale (needs the renderer, GLFW, Dear ImGui, CLI11)" ${PROJECT_IS_TOP_LEVEL})
option(PERCALE_BUILD_BENCH "Build the benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(PERCALE_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(PERCALE_WERROR "Warnings are errors" OFF)
option(PERCALE_UNITY "Compile several files as one: half the time for all, more for one changed file" OFF)
set(PERCALE_SANITIZE "" CACHE STRING "Sanitizers to build with, such as address,undefined")
option(PERCALE_COVERAGE "Record which lines run" OFF)
set(PERCALE_PARALLEL "tbb" CACHE STRING "Back end of the parallel loop: tbb, std (plain threads) or serial")
set_property(CACHE PERCALE_PARALLEL PROPERTY STRINGS tbb std serial)

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)  # where ./run looks
  find_program(PERCALE_CCACHE ccache)
  if(PERCALE_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${PERCALE_CCACHE})
  endif()
endif()

# What all our targets share. -ffp-contract=off keeps results equal to the bit between instruction
# sets; the other flags let loops over arrays vectorise and change no result.
add_library(percale_flags INTERFACE)
target_compile_features(percale_flags INTERFACE cxx_std_20)
if(MSVC)
  target_compile_options(percale_flags INTERFACE /W4 /permissive- /utf-8 /fp:precise $<$<BOOL:${PERCALE_WERROR}>:/WX>)
  target_compile_definitions(percale_flags INTERFACE _USE_MATH_DEFINES NOMINMAX)
else()
  target_compile_options(percale_flags INTERFACE
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor -ffp-contract=off -fno-math-errno -fno-trapping-math
    $<$<BOOL:${PERCALE_WERROR}>:-Werror>
    # g++ 12 sees overlaps, ends and uninitialised parts in std::string and std::optional that are not there (GCC bugs
    # 105651, 105562); all the more with sanitizers, which find the true ones.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-maybe-uninitialized>)
endif()
if(PERCALE_UNITY AND NOT WIN32)  # what windows.h defines would reach other files
  # Files that are compiled with flags of their own, such as kernels, stay alone. With more at once, one changed file would
  # take more than 15 s.
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 5)
  # Parts of one file that another includes look as if they had to be known elsewhere.
  target_compile_options(percale_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(PERCALE_SANITIZE)
  target_compile_options(percale_flags INTERFACE -fsanitize=${PERCALE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(PERCALE_SANITIZE MATCHES "address")
    # A wild pointer stops the address sanitizer as well; asking before every use takes half of the time to compile.
    target_compile_options(percale_flags INTERFACE -fno-sanitize=null,alignment,pointer-overflow)
  endif()
  target_link_options(percale_flags INTERFACE -fsanitize=${PERCALE_SANITIZE})
  if(PERCALE_SANITIZE MATCHES "address" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    set(PERCALE_IN_PROGRAM "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>")
    target_sources(percale_flags INTERFACE "$<${PERCALE_IN_PROGRAM}:${PROJECT_SOURCE_DIR}/cmake/keep_loaded.cpp>")
    target_link_options(percale_flags INTERFACE "$<${PERCALE_IN_PROGRAM}:LINKER:--export-dynamic-symbol=dlclose>")
  endif()
endif()
if(PERCALE_COVERAGE)
  target_compile_options(percale_flags INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(percale_flags INTERFACE --coverage)
endif()

# percale_precompile(TARGET ...): with what most files include compiled once for all these targets. ccache would not see
# what changed in it.
option(PERCALE_PRECOMPILE "Compile the headers that most files include once" ON)
if(PERCALE_CCACHE)
  set(PERCALE_PRECOMPILE OFF)
endif()
if(PERCALE_PRECOMPILE)
  file(WRITE ${PROJECT_BINARY_DIR}/precompiled.cpp "")
  add_library(percale_precompiled OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(percale_precompiled PRIVATE percale_flags)
  target_precompile_headers(percale_precompiled PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h)
endif()
function(percale_precompile)
  if(PERCALE_PRECOMPILE)
    foreach(target ${ARGN})
      target_precompile_headers(${target} REUSE_FROM percale_precompiled)
    endforeach()
  endif()
endfunction()

# percale_glue(TARGET ...): what calls fast code without being it. -O1 takes two thirds of the time to compile.
function(percale_glue)
  if(NOT MSVC AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    foreach(target ${ARGN})
      target_compile_options(${target} PRIVATE -O1)
    endforeach()
  endif()
endfunction()
