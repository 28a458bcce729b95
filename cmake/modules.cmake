# sheen_module(NAME SOURCES ... LINK ... PRECOMPILE ...): one static library per module, headers
# included by their path from the repository root. PRECOMPILE names heavy headers that many of its
# sources include, besides those that every module does; each source still includes what it uses.
set(SHEEN_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <string>
  <vector> <Eigen/Geometry> <opencv2/core.hpp>)

function(sheen_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;LINK;PRIVATE_LINK;PRECOMPILE" ${ARGN})
  add_library(sheen_${name} STATIC ${MODULE_SOURCES})
  target_include_directories(sheen_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(sheen_${name} PUBLIC ${MODULE_LINK} PRIVATE ${MODULE_PRIVATE_LINK} sheen_warnings)
  target_precompile_headers(sheen_${name} PRIVATE ${SHEEN_COMMON_HEADERS} ${MODULE_PRECOMPILE})
endfunction()

# sheen_kernels(OPTIONS SOURCES ...): sources that are compiled with options of their own, which no
# precompiled header was made with.
function(sheen_kernels options)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "${options}" SKIP_PRECOMPILE_HEADERS ON)
endfunction()
