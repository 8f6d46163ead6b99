# What every target of ours shares: warnings, sanitizers, and arithmetic that is the same on every run.

function(egocal_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  # a*b+c must round the same way wherever it is compiled: answers are bit-identical from run to run
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(EGOCAL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(EGOCAL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${EGOCAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${EGOCAL_SANITIZE})
  endif()
endfunction()

# A program of ours: lands in build/bin, is installed to bin, knows its version.
function(egocal_add_program name)
  add_executable(${name} ${ARGN})
  egocal_target_defaults(${name})
  target_compile_definitions(${name} PRIVATE EGOCAL_VERSION="${PROJECT_VERSION}")
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()
