# The Debian packages that dicot needs, by purpose, and how the missing ones are installed. To be sourced.
#
#   dicot_install build quickstart    installs what is missing for these purposes; touches apt only if something is

dicot_packages() {
    case $1 in
        build) echo "g++ cmake ninja-build pkg-config libpng-dev zlib1g-dev libjpeg62-turbo-dev libyaml-dev libmd-dev libcli11-dev
            nlohmann-json3-dev libeigen3-dev libdraco-dev libusb-1.0-0-dev libtomlplusplus-dev libsqlite3-dev" ;;
        # Node may be there from elsewhere, and Debian's npm does not stand beside that.
        viewer) echo "libcpp-httplib-dev" && { command -v npm >/dev/null 2>&1 || echo "npm"; } ;;
        browser) echo "chromium" ;;
        quickstart) echo "libjpeg-turbo-progs" ;; # djpeg scales the pair
        # tzdata: every zone of it is read; draco, pcl-tools: readers of others for our files; OpenCV: a yardstick beside ours;
        # the second line's make and read packages
        test) echo "libgtest-dev libgmock-dev libopencv-calib3d-dev draco pcl-tools python3 tzdata
            dpkg-dev binutils man-db systemd" ;;
        clang) echo "clang-14 libclang-rt-14-dev" ;;
        lint) echo "clang-format-14 clang-tidy-14 shellcheck" ;;
        cross) echo "g++-aarch64-linux-gnu g++-arm-linux-gnueabihf qemu-user mmdebstrap" ;;
        vm) echo "g++-aarch64-linux-gnu mmdebstrap qemu-system-arm kmod cpio binutils
            e2fsprogs device-tree-compiler" ;;
        *)
            echo "dicot: there is no purpose '$1' in toolchain/packages.sh" >&2
            return 64
            ;;
    esac
}

dicot_missing() {
    for purpose in "$@"; do
        for package in $(dicot_packages "$purpose"); do
            case $(dpkg-query -W -f '${Status}' "$package" 2>/dev/null) in
                'install ok installed') ;;
                *) printf '%s ' "$package" ;;
            esac
        done
    done
}

dicot_install() {
    for purpose in "$@"; do
        dicot_packages "$purpose" >/dev/null || return
    done
    dicot_wanted=$(dicot_missing "$@")
    [ -n "$dicot_wanted" ] || return 0
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "dicot: this system has no apt-get; install these yourself, or use Debian 12: $dicot_wanted" >&2
        return 69
    fi
    if [ "$(id -u)" != 0 ]; then
        echo "dicot: packages are missing and only root can install them; run this, then start again:" >&2
        echo "  sudo apt-get install --no-install-recommends $dicot_wanted" >&2
        return 77
    fi
    echo "installing: $dicot_wanted"
    dicot_apt_log=$(mktemp)
    # The package lists may be absent or old: they are fetched only if it does not work with those at hand.
    # shellcheck disable=SC2086 # a list of words
    if dicot_apt_get install $dicot_wanted >"$dicot_apt_log" 2>&1 ||
        { dicot_apt_get update >>"$dicot_apt_log" 2>&1 && dicot_apt_get install $dicot_wanted >>"$dicot_apt_log" 2>&1; }; then
        rm -f "$dicot_apt_log"
        return 0
    fi
    tail -n 15 "$dicot_apt_log" >&2
    rm -f "$dicot_apt_log"
    echo "dicot: apt-get could not install the packages above; mend its complaint (network, disk, sources) and start again" >&2
    return 69
}

dicot_apt_get() {
    DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends "$@" </dev/null
}
