set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(DICOT_TRIPLE aarch64-linux-gnu)
set(DICOT_DEBIAN_ARCH arm64)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
