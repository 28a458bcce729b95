# sheen_room(NAME SOURCES ... LINK ...): one static library per room, headers
# included by their path from the repository root.
function(sheen_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(sheen_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(sheen_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(sheen_${name} PUBLIC ${ROOM_LINK} PRIVATE ${ROOM_PRIVATE_LINK} sheen_warnings)
endfunction()
