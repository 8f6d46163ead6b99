# Precompiled headers: what nearly every file includes is parsed once instead of five hundred times. Off by default: they
# hide a missing #include, a change of one of our headers compiles everything again, and ccache is faster where it is there.
# scripts/test uses them for builds from scratch without ccache. What does not compile with them is compiled without them
# (scripts/compile-precompiled): warnings may be errors.
option(EGOCAL_PRECOMPILE "Precompile Eigen, the standard library, our interface and GoogleTest for builds from scratch" OFF)
if(EGOCAL_PRECOMPILE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PROJECT_SOURCE_DIR}/scripts/compile-precompiled)
endif()

set(EGOCAL_PRECOMPILED_HEADERS <Eigen/Dense> <algorithm> <array> <cmath> <deque> <filesystem> <fstream> <functional>
                               <iostream> <map> <memory> <numeric> <optional> <random> <set> <span> <sstream> <string>
                               <vector> <egocal/egocal.hpp>)

# Clang compiles everything alike, position-independent, so that one serves all; GCC's suit one set of flags each.
if(EGOCAL_PRECOMPILE AND EGOCAL_BUILD_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(EGOCAL_ONE_PRECOMPILED ON)
endif()

# One for all programs and one for all programs of tests.
function(egocal_add_precompiled)
  if(NOT EGOCAL_PRECOMPILE)
    return()
  endif()
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "// holds the precompiled headers\n")
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  foreach(name egocal_precompiled egocal_precompiled_tests)
    if((name STREQUAL egocal_precompiled_tests AND NOT EGOCAL_BUILD_TESTS)
       OR (name STREQUAL egocal_precompiled AND EGOCAL_ONE_PRECOMPILED))
      continue()
    endif()
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    egocal_compile_flags(${name})
    target_link_libraries(${name} PRIVATE Eigen3::Eigen)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/lib/include ${PROJECT_BINARY_DIR}/lib/include)
    set(headers ${EGOCAL_PRECOMPILED_HEADERS})
    if(name STREQUAL egocal_precompiled_tests)
      find_package(GTest REQUIRED)
      target_link_libraries(${name} PRIVATE GTest::gmock)
      egocal_compile_once(${name})
      list(APPEND headers <gmock/gmock.h> <gtest/gtest.h>)
    endif()
    if(EGOCAL_ONE_PRECOMPILED)
      target_compile_options(${name} PRIVATE -fPIC)
    endif()
    target_precompile_headers(${name} PRIVATE ${headers})
  endforeach()
endfunction()

# The library's own, as it is position-independent; one of the two above for everything else.
function(egocal_precompile target kind)
  if(NOT EGOCAL_PRECOMPILE OR kind STREQUAL "none")
    return()
  endif()
  if(EGOCAL_ONE_PRECOMPILED)
    target_compile_options(${target} PRIVATE -fPIC)  # CMake's own for programs is -fPIE
    target_precompile_headers(${target} REUSE_FROM egocal_precompiled_tests)
  elseif(kind STREQUAL "library" AND NOT target STREQUAL "egocal")
    target_precompile_headers(${target} REUSE_FROM egocal)
  elseif(kind STREQUAL "library")
    target_precompile_headers(${target} PRIVATE ${EGOCAL_PRECOMPILED_HEADERS})
  elseif(kind STREQUAL "tests")
    target_precompile_headers(${target} REUSE_FROM egocal_precompiled_tests)
  else()
    target_precompile_headers(${target} REUSE_FROM egocal_precompiled)
  endif()
endfunction()
