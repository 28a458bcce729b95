# find_package(sheen) for programs outside: targets sheen::core, sheen::capture, sheen::fitting,
# sheen::render, sheen::pipeline; headers as <sheen/pipeline/reconstruct.h>.
# They are the component "development"; the program with its documents is "program".
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/sheen)

foreach(module core capture fitting render pipeline)
  set_target_properties(sheen_${module} PROPERTIES EXPORT_NAME ${module})
  install(TARGETS sheen_${module} EXPORT sheen ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sheen
    FILES_MATCHING PATTERN "*.h" PATTERN "*.lens")
endforeach()
install(TARGETS sheen_opencv EXPORT sheen)
install(EXPORT sheen NAMESPACE sheen:: DESTINATION ${package_folder})

configure_package_config_file(cmake/sheenConfig.cmake.in ${CMAKE_BINARY_DIR}/sheenConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/sheenConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/sheenConfig.cmake ${CMAKE_BINARY_DIR}/sheenConfigVersion.cmake
  DESTINATION ${package_folder})
