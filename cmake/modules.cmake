# sheen_module(NAME SOURCES ... LINK ... PRECOMPILE ...): one static library per module, headers
# included by their path from the repository root. PRECOMPILE names heavy headers that many of its
# sources include, besides those that every module does; each source still includes what it uses. In
# a unity build (presets release, asan, tsan) the sources of one folder are compiled as one, and those
# of the module's small folders, too.
set(SHEEN_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <string>
  <vector> <Eigen/Geometry> <opencv2/core.hpp>)

function(sheen_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;LINK;PRIVATE_LINK;PRECOMPILE" ${ARGN})
  add_library(sheen_${name} STATIC ${MODULE_SOURCES})
  add_library(sheen::${name} ALIAS sheen_${name})
  sheen_unity_folders(sheen_${name} ${MODULE_SOURCES})
  # Installed headers are named <sheen/core/...> outside and include each other as inside.
  target_include_directories(sheen_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/sheen>)
  target_compile_features(sheen_${name} PUBLIC cxx_std_20)
  target_link_libraries(sheen_${name}
    PUBLIC ${MODULE_LINK}
    PRIVATE ${MODULE_PRIVATE_LINK} $<BUILD_INTERFACE:sheen_warnings>)
  target_precompile_headers(sheen_${name} PRIVATE ${SHEEN_COMMON_HEADERS} ${MODULE_PRECOMPILE})
endfunction()

# sheen_unity_folders(TARGET SOURCES ...): what a unity build compiles as one. Most of a compiler's time
# goes into headers and templates, so small folders share it.
function(sheen_unity_folders target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${target}_${folder}" group)
    list(APPEND groups ${group})
    list(APPEND sources_of_${group} ${source})
  endforeach()
  list(REMOVE_DUPLICATES groups)
  foreach(group IN LISTS groups)
    set(sources ${sources_of_${group}})
    list(LENGTH sources count)
    if(count LESS 5)
      set(group "${target}_small_folders")
    endif()
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# sheen_kernels(OPTIONS SOURCES ...): sources that are compiled with options of their own, which no
# precompiled header was made with.
function(sheen_kernels options)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "${options}" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# sheen_embed(OUTPUT [ROOT folder] FUNCTION f NAMESPACE n HEADER h FILES ...): makes the C++ file
# OUTPUT, in which the function returns the text of a file by its name below ROOT, so that the program
# needs no files at run time.
function(sheen_embed output)
  cmake_parse_arguments(EMBED "" "ROOT;FUNCTION;NAMESPACE;HEADER" "FILES" ${ARGN})
  cmake_path(ABSOLUTE_PATH EMBED_ROOT)
  list(TRANSFORM EMBED_FILES PREPEND ${EMBED_ROOT}/ OUTPUT_VARIABLE sources)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DFILES=${EMBED_FILES}" -DROOT=${EMBED_ROOT}
      -DOUTPUT=${output} -DFUNCTION=${EMBED_FUNCTION} -DNAMESPACE=${EMBED_NAMESPACE}
      -DHEADER=${EMBED_HEADER} -P ${script}
    DEPENDS ${sources} ${script}
    COMMENT "Embedding ${EMBED_FUNCTION}"
    VERBATIM)
endfunction()
