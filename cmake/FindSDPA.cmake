# Finds SDPA's callable library (Debian: libsdpa-dev; a static library without a CMake package, so what it needs
# itself is looked up here). Defines SDPA::sdpa. Only the benchmarks use it.
find_path(SDPA_INCLUDE_DIR sdpa_call.h)
find_path(SDPA_MUMPS_INCLUDE_DIR dmumps_c.h)
find_library(SDPA_LIBRARY sdpa)
find_library(SDPA_MUMPS_LIBRARY dmumps_seq)
find_library(SDPA_LAPACK_LIBRARY lapack)
find_library(SDPA_BLAS_LIBRARY blas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SDPA REQUIRED_VARS SDPA_LIBRARY SDPA_INCLUDE_DIR SDPA_MUMPS_INCLUDE_DIR
                                                     SDPA_MUMPS_LIBRARY SDPA_LAPACK_LIBRARY SDPA_BLAS_LIBRARY)
if(SDPA_FOUND AND NOT TARGET SDPA::sdpa)
  add_library(SDPA::sdpa UNKNOWN IMPORTED)
  set_target_properties(SDPA::sdpa PROPERTIES
    IMPORTED_LOCATION "${SDPA_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SDPA_INCLUDE_DIR};${SDPA_MUMPS_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${SDPA_MUMPS_LIBRARY};${SDPA_LAPACK_LIBRARY};${SDPA_BLAS_LIBRARY};pthread")
endif()
mark_as_advanced(SDPA_INCLUDE_DIR SDPA_MUMPS_INCLUDE_DIR SDPA_LIBRARY SDPA_MUMPS_LIBRARY SDPA_LAPACK_LIBRARY
                 SDPA_BLAS_LIBRARY)
