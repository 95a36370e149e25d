# Every third party of the house, found once; whose door each one has is written in DicotRooms.cmake.
find_package(Threads REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(libjpeg REQUIRED IMPORTED_TARGET libjpeg)
pkg_check_modules(yaml REQUIRED IMPORTED_TARGET yaml-0.1)
pkg_check_modules(libmd REQUIRED IMPORTED_TARGET libmd)
pkg_check_modules(libusb REQUIRED IMPORTED_TARGET libusb-1.0>=1.0.24)
pkg_check_modules(sqlite REQUIRED IMPORTED_TARGET sqlite3>=3.31)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)

# Draco's own CMake files name paths of the machine that packaged it.
find_path(DRACO_INCLUDE_DIR draco/compression/encode.h REQUIRED)
find_library(DRACO_LIBRARY NAMES libdraco.a draco REQUIRED)
add_library(dicot_draco INTERFACE)
target_include_directories(dicot_draco SYSTEM INTERFACE "${DRACO_INCLUDE_DIR}")
target_link_libraries(dicot_draco INTERFACE "${DRACO_LIBRARY}")

# Headers alone, without exceptions: Debian's pkg-config file asks for the shared library, which has them.
find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h REQUIRED)
add_library(dicot_toml INTERFACE)
target_include_directories(dicot_toml SYSTEM INTERFACE "${TOMLPLUSPLUS_INCLUDE_DIR}")
target_compile_definitions(dicot_toml INTERFACE TOML_HEADER_ONLY=1 TOML_EXCEPTIONS=0)

# OpenCV is a yardstick of tests, never a part of the program. Debian's CMake files for it come with all of OpenCV.
if(DICOT_TESTS)
  find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
  add_library(dicot_opencv INTERFACE)
  target_include_directories(dicot_opencv SYSTEM INTERFACE "${OPENCV_INCLUDE_DIR}")
  foreach(part calib3d imgproc core)
    find_library(OPENCV_${part}_LIBRARY opencv_${part} REQUIRED)
    target_link_libraries(dicot_opencv INTERFACE "${OPENCV_${part}_LIBRARY}")
  endforeach()
endif()
