# Finds NLopt's C library. Defines NLopt::nlopt. (Debian's config package in nlopt_cxx names a target without a
# namespace; newer ones differ; header and library are all that is needed.)
find_path(NLOPT_INCLUDE_DIR nlopt.h)
find_library(NLOPT_LIBRARY NAMES nlopt)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(NLopt REQUIRED_VARS NLOPT_LIBRARY NLOPT_INCLUDE_DIR)
if(NLopt_FOUND AND NOT TARGET NLopt::nlopt)
  add_library(NLopt::nlopt UNKNOWN IMPORTED)
  set_target_properties(NLopt::nlopt PROPERTIES IMPORTED_LOCATION "${NLOPT_LIBRARY}"
                                                INTERFACE_INCLUDE_DIRECTORIES "${NLOPT_INCLUDE_DIR}")
endif()
mark_as_advanced(NLOPT_INCLUDE_DIR NLOPT_LIBRARY)
