# The program's package for Debian: scripts/package builds build/sheen_VERSION_ARCHITECTURE.deb.
find_program(DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
install(CODE "execute_process(COMMAND \"${DEBIAN_PYTHON}\" \"${PROJECT_SOURCE_DIR}/package/command_docs.py\"
  \"${CMAKE_BINARY_DIR}/sheen\" --share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\"
  COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
install(FILES package/sheen.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES package/sheen.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)
install(FILES package/copyright README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT program)
install(DIRECTORY sample_data DESTINATION ${CMAKE_INSTALL_DATADIR}/sheen COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sheen)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "capture how an object looks from every direction")
set(CPACK_PACKAGE_DESCRIPTION "Walk round an object on a printed board with a camera: Sheen finds the camera from the
board's tags, fits the light that leaves every point of the object's mesh as a function of direction (a
surface light field) while frames arrive, shows where views are missing, and draws the result from anywhere.")
set(CPACK_PACKAGE_CONTACT "the Sheen authors <sheen@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME sheen)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is loaded only when it is needed: drawing without a display, windows and GPUs, the window's font.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libegl1, libgl1, libgl1-mesa-dri, fonts-inter")
include(CPack)
