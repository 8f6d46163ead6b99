# Finds LCM. Prefers the config package that LCM >= 1.4 installs; Debian's 1.3.1 has none (and its pkg-config
# file fails without glib's -dev package), so otherwise header, library and lcm-gen are looked up by hand.
# Defines the targets LCM::lcm and LCM::lcm-gen.

# not from the user's package registry: any build of LCM ever configured on this machine enters itself there
find_package(lcm CONFIG QUIET NO_CMAKE_PACKAGE_REGISTRY)
if(lcm_FOUND AND TARGET lcm AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm INTERFACE IMPORTED)
  target_link_libraries(LCM::lcm INTERFACE lcm)
  set(LCM_LIBRARY lcm)
  get_target_property(LCM_INCLUDE_DIR lcm INTERFACE_INCLUDE_DIRECTORIES)
  if(TARGET lcm-gen)
    add_executable(LCM::lcm-gen ALIAS lcm-gen)
    set(LCM_GEN lcm-gen)
  endif()
elseif(lcm_FOUND AND TARGET lcm::lcm AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm ALIAS lcm::lcm)
  set(LCM_LIBRARY lcm::lcm)
  get_target_property(LCM_INCLUDE_DIR lcm::lcm INTERFACE_INCLUDE_DIRECTORIES)
else()
  find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp)
  find_library(LCM_LIBRARY lcm)
  if(LCM_INCLUDE_DIR AND EXISTS ${LCM_INCLUDE_DIR}/lcm/lcm.h)
    set(LCM_VERSION)
    foreach(part MAJOR MINOR MICRO)
      file(STRINGS ${LCM_INCLUDE_DIR}/lcm/lcm.h line REGEX "^#define LCM_${part}_VERSION +[0-9]+")
      string(REGEX MATCH "[0-9]+" number "${line}")
      list(APPEND LCM_VERSION ${number})
    endforeach()
    list(JOIN LCM_VERSION "." LCM_VERSION)
  endif()
endif()
if(NOT LCM_GEN)
  find_program(LCM_GEN lcm-gen)
endif()

include(FindPackageHandleStandardArgs)
if(lcm_FOUND)
  set(LCM_VERSION ${lcm_VERSION})
  set(LCM_LIBRARY "${LCM_LIBRARY} of ${lcm_DIR}")  # for the message alone
endif()
find_package_handle_standard_args(LCM
  REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR LCM_GEN VERSION_VAR LCM_VERSION
  REASON_FAILURE_MESSAGE "install the packages liblcm-dev and liblcm-bin (Debian, Ubuntu) or LCM from source, with \
its folder in CMAKE_PREFIX_PATH, or build the library alone with -DEGOCAL_BUILD_PROGRAMS=OFF")

if(LCM_FOUND AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm UNKNOWN IMPORTED)
  set_target_properties(LCM::lcm PROPERTIES IMPORTED_LOCATION "${LCM_LIBRARY}"
                                            INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
endif()
if(LCM_FOUND AND NOT TARGET LCM::lcm-gen)
  add_executable(LCM::lcm-gen IMPORTED)
  set_target_properties(LCM::lcm-gen PROPERTIES IMPORTED_LOCATION "${LCM_GEN}")
endif()
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN)
