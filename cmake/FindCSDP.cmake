# Finds CSDP's callable library (Debian: libsdp-dev, which has no CMake package). Defines CSDP::csdp. Only the benchmarks use it.
find_path(CSDP_INCLUDE_DIR csdp/declarations.h)
find_library(CSDP_LIBRARY sdp)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CSDP REQUIRED_VARS CSDP_LIBRARY CSDP_INCLUDE_DIR)
if(CSDP_FOUND AND NOT TARGET CSDP::csdp)
  add_library(CSDP::csdp UNKNOWN IMPORTED)
  set_target_properties(CSDP::csdp PROPERTIES IMPORTED_LOCATION "${CSDP_LIBRARY}"
                                              INTERFACE_INCLUDE_DIRECTORIES "${CSDP_INCLUDE_DIR};${CSDP_INCLUDE_DIR}/csdp")
endif()
mark_as_advanced(CSDP_INCLUDE_DIR CSDP_LIBRARY)
