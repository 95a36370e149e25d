set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(DICOT_TRIPLE arm-linux-gnueabihf)
set(DICOT_DEBIAN_ARCH armhf)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
