# Everything comes from Debian 12; scripts/packages.txt lists the package names.
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d videoio aruco)
find_package(embree 3 REQUIRED)
find_package(apriltag REQUIRED)
find_package(Ceres REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(assimp REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(yaml_cpp REQUIRED IMPORTED_TARGET yaml-cpp)

# Library headers warn under our flags; SYSTEM silences them, not us.
add_library(sheen_opencv INTERFACE)
target_include_directories(sheen_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(sheen_opencv INTERFACE opencv_core opencv_imgproc opencv_imgcodecs)
