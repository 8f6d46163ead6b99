# Each folder as one file: what its files include and instantiate alike is compiled once (40 % less). Off by default: a change
# of one file compiles its folder again. scripts/test uses it for builds from scratch without ccache. What files of a folder
# keep to themselves has names of its own, which no local of a neighbour hides.
option(EGOCAL_FOLDERS "Compile the files of a folder together in builds from scratch" OFF)

# GCC collects its garbage from 128 MB on, again and again in a folder of expression templates: a tenth of the time.
function(egocal_collect_later target)
  if(EGOCAL_FOLDERS AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE "SHELL:--param ggc-min-heapsize=500000" "SHELL:--param ggc-min-expand=100")
  endif()
endfunction()

function(egocal_compile_folders target)
  if(NOT EGOCAL_FOLDERS)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ${source} ABSOLUTE)
    get_filename_component(folder ${folder} DIRECTORY)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
