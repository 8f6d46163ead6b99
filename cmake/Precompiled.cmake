# Precompiled headers: what nearly every file includes is parsed once instead of five hundred times. Off by default: they
# hide a missing #include, ccache is faster where it is there, and GCC 12 warns of bounds inside of precompiled standard
# headers (a false alarm that it suppresses otherwise): not for builds whose warnings are errors.
option(EGOCAL_PRECOMPILE "Precompile Eigen, the standard library and GoogleTest for builds from scratch" OFF)

set(EGOCAL_PRECOMPILED_HEADERS <Eigen/Dense> <algorithm> <array> <cmath> <deque> <functional> <map> <memory> <optional>
                               <span> <string> <vector>)

# One for all programs and one for all programs of tests; a precompiled header suits one set of flags.
function(egocal_add_precompiled)
  if(NOT EGOCAL_PRECOMPILE)
    return()
  endif()
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "// holds the precompiled headers\n")
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  foreach(name egocal_precompiled egocal_precompiled_tests)
    if(name STREQUAL egocal_precompiled_tests AND NOT EGOCAL_BUILD_TESTS)
      continue()
    endif()
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    egocal_compile_flags(${name})
    target_link_libraries(${name} PRIVATE Eigen3::Eigen)
    set(headers ${EGOCAL_PRECOMPILED_HEADERS})
    if(name STREQUAL egocal_precompiled_tests)
      find_package(GTest REQUIRED)
      target_link_libraries(${name} PRIVATE GTest::gtest)
      list(APPEND headers <gtest/gtest.h>)
    endif()
    target_precompile_headers(${name} PRIVATE ${headers})
  endforeach()
endfunction()

# The library's own, as it is position-independent; one of the two above for everything else.
function(egocal_precompile target kind)
  if(NOT EGOCAL_PRECOMPILE OR kind STREQUAL "none")
    return()
  elseif(kind STREQUAL "library")
    target_precompile_headers(${target} PRIVATE ${EGOCAL_PRECOMPILED_HEADERS})
  elseif(kind STREQUAL "tests")
    target_precompile_headers(${target} REUSE_FROM egocal_precompiled_tests)
  else()
    target_precompile_headers(${target} REUSE_FROM egocal_precompiled)
  endif()
endfunction()
