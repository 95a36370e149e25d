# Read by CPack when it makes the package: the dependencies that depends.sh found in the meantime.
file(STRINGS "${CPACK_DICOT_DEPENDS_FILE}" depends LIMIT_COUNT 1)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "${depends}, systemd, udev")
