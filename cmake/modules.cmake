# sheen_module(NAME SOURCES ... LINK ...): one static library per module, headers
# included by their path from the repository root.
function(sheen_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(sheen_${name} STATIC ${MODULE_SOURCES})
  target_include_directories(sheen_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(sheen_${name} PUBLIC ${MODULE_LINK} PRIVATE ${MODULE_PRIVATE_LINK} sheen_warnings)
endfunction()
