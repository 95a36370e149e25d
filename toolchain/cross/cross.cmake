# Debian's cross compiler for DICOT_TRIPLE and the sysroot that sysroot.sh made for DICOT_DEBIAN_ARCH.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_CXX_COMPILER ${DICOT_TRIPLE}-g++)
set(CMAKE_C_COMPILER ${DICOT_TRIPLE}-gcc)

get_filename_component(checkout "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
set(CMAKE_SYSROOT "${checkout}/.cache/sysroot-${DICOT_DEBIAN_ARCH}")
if(NOT EXISTS "${CMAKE_SYSROOT}/recipe")
  message(FATAL_ERROR "There is no sysroot yet: run 'sh toolchain/cross/sysroot.sh ${DICOT_DEBIAN_ARCH}' first.")
endif()

# Programs are this machine's; libraries, headers and packages are the other one's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_LIBRARY_ARCHITECTURE ${DICOT_TRIPLE})
set(ENV{PKG_CONFIG_DIR} "")
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${CMAKE_SYSROOT}")
set(ENV{PKG_CONFIG_LIBDIR} "${CMAKE_SYSROOT}/usr/lib/${DICOT_TRIPLE}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig")

set(DICOT_TESTS OFF CACHE BOOL "Tests run on the machine that builds" FORCE)
