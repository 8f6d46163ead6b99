# What every target of ours shares: warnings, sanitizers, and arithmetic that is the same on every run.

include(CheckCXXSourceCompiles)
include(Folders)
include(Precompiled)

# whether the flags of this build (-march=native) allow fused multiply-adds
check_cxx_source_compiles("#ifndef __FMA__\n#error\n#endif\nint main() {}" EGOCAL_HAS_FMA)

# install(), where egocal is not part of another project
macro(egocal_install)
  if(EGOCAL_INSTALL)
    install(${ARGN})
  endif()
endmacro()

# egocal_target_defaults(target [library|tests|none]): which precompiled headers suit it, those of programs by default.
function(egocal_target_defaults target)
  egocal_compile_flags(${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  list(APPEND ARGN programs)
  list(GET ARGN 0 kind)
  egocal_precompile(${target} ${kind})
  if(kind STREQUAL "tests")
    egocal_compile_once(${target})
  else()
    egocal_compile_folders(${target})
  endif()
endfunction()

# A test's own code runs once or twice: optimising it takes longer than it saves (a quarter of its compilation). What it tests is
# optimised as users get it. With -O1 GCC sees the free() in an operator delete of ours, but not the malloc() in its new.
function(egocal_compile_once target)
  target_compile_options(${target} PRIVATE
    "$<$<AND:$<CONFIG:RelWithDebInfo>,$<CXX_COMPILER_ID:GNU>>:-O1;-Wno-mismatched-new-delete>")
endfunction()

function(egocal_compile_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  egocal_collect_later(${target})
  # a*b+c must round the same way wherever it is compiled: answers are bit-identical from run to run
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  # GCC's vectoriser of straight code fuses products with alternating sums in spite of it (GCC 12: vfmaddsub)
  if(EGOCAL_HAS_FMA)
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
  endif()
  # GCC 12 warns with -O3, wrongly, of `"x" + std::string()` (GCC bug 105651) and of strings that are moved; the builds
  # whose warnings are errors look for both
  target_compile_options(${target} PRIVATE
    "$<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-maybe-uninitialized>")
  if(EGOCAL_HARDENING AND NOT EGOCAL_SANITIZE)
    # writes past the end of a buffer or of the stack end the process instead of going on
    target_compile_options(${target} PRIVATE
      "$<$<CONFIG:Release>:SHELL:-fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>")
    # addresses of functions in shared libraries are resolved at the start and cannot be overwritten
    target_link_options(${target} PRIVATE "$<$<CONFIG:Release>:LINKER:-z,relro,-z,now>")
  endif()
  if(EGOCAL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(EGOCAL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${EGOCAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${EGOCAL_SANITIZE})
  endif()
  if(EGOCAL_BUILD_FUZZERS)
    target_compile_options(${target} PRIVATE
      -fsanitize=fuzzer-no-link -fsanitize-coverage-ignorelist=${PROJECT_SOURCE_DIR}/cmake/coverage_ignorelist.txt)
  endif()
endfunction()

# A program of ours: lands in build/bin, is installed to bin with its manual pages, knows its version. The target
# egocal-program makes the program egocal, as the library has that name already.
function(egocal_add_program name)
  add_executable(${name} ${ARGN})
  egocal_target_defaults(${name})
  target_compile_definitions(${name} PRIVATE EGOCAL_VERSION="${PROJECT_VERSION}")
  egocal_install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  string(REGEX REPLACE "-program$" "" program ${name})
  egocal_document_program(${name} ${program})
endfunction()

# Manual pages and shell completion of a program, written by the program itself from its command line.
function(egocal_document_program target program)
  if(NOT EGOCAL_INSTALL OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  set(share ${CMAKE_BINARY_DIR}/manual/${program})
  file(MAKE_DIRECTORY ${share})
  add_custom_command(
    OUTPUT ${share}/written
    COMMAND ${target} --manual ${share} ${PROJECT_VERSION}
    COMMAND ${CMAKE_COMMAND} -E touch ${share}/written
    DEPENDS ${target}
    COMMENT "Manual pages and shell completion of ${program}")
  add_custom_target(${program}-manual ALL DEPENDS ${share}/written)
  install(DIRECTORY ${share}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs FILES_MATCHING PATTERN *.1)
  set(completions ${CMAKE_INSTALL_DATADIR})
  install(FILES ${share}/${program}.bash DESTINATION ${completions}/bash-completion/completions RENAME ${program}
          COMPONENT programs)
  install(FILES ${share}/_${program} DESTINATION ${completions}/zsh/vendor-completions COMPONENT programs)
  install(FILES ${share}/${program}.fish DESTINATION ${completions}/fish/vendor_completions.d COMPONENT programs)
endfunction()
