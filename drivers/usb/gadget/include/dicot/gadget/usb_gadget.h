// The gadget as the kernel keeps it: a folder of configfs, and a mounted FunctionFS.
#pragma once

#include "dicot/base/status.h"

#include <cstdint>
#include <string>
#include <sys/types.h>

namespace dicot {

/// Where the kernel's folders are; another place in tests.
struct GadgetPlaces
{
    std::string config = "/sys/kernel/config"; ///< configfs
    std::string controllers = "/sys/class/udc";
    std::string run = "/run/dicot-usb"; ///< ours: FunctionFS is mounted in it, the server's page lies there

    std::string gadget() const { return config + "/usb_gadget/dicot"; }
    std::string mount() const { return run + "/ffs"; }
    std::string server() const { return run + "/server"; }
};

/// What a computer reads before it asks anything of MTP.
struct GadgetWords
{
    static constexpr std::uint16_t kVendor = 0x1d6b;  ///< Linux Foundation
    static constexpr std::uint16_t kProduct = 0x0100; ///< "PTP Gadget"
    static constexpr const char* kManufacturer = "dicot";

    std::uint16_t version_bcd = 0x0100;
    std::string product; ///< "dicot NAME"
    std::string serial;  ///< letters, digits, '.', '_', '-'
};

/// Steps that can be repeated: each finds what an earlier process left, and takes it over. All take memory from the
/// heap, so they come before the seal or after the end, but for those that say so.
class UsbGadget
{
public:
    explicit UsbGadget(GadgetPlaces places = {}) : places_(std::move(places)) {}
    const GadgetPlaces& places() const noexcept { return places_; }

    /// The controller that is asked for, or the first one. Fault::kUnavailable: this board has none (of that name), and
    /// what to do about it.
    Result<std::string> controller(const std::string& wanted) const;

    /// The folder of what runs: this user's (root's, as prepare() wants it) and nobody else's to write, whatever the
    /// mask. What another user left there has no say. Fault::kUnavailable: not this user's to make; kOsError: a link, a
    /// file.
    Status make_run_folder() const;
    bool there() const; ///< the gadget's folder, whoever made it
    /// Root's part. Loads libcomposite and mounts configfs where they are missing; makes the gadget, unbound, and
    /// mounts its FunctionFS, both to be used by `user`; the folder that it is mounted in stays root's. Whoever serves
    /// must have ended. Fault::kUnavailable: no kernel support, not root; kOsError.
    Status prepare(const GadgetWords& words, uid_t user, gid_t group);
    /// The folder of the gadget alone: no mount, no owner.
    Status make(const GadgetWords& words) const;
    /// All that prepare() made goes. Fault::kUnavailable: not root; kOsError.
    Status remove();
    bool prepared() const; ///< FunctionFS is mounted

    /// From now on the computer sees it. The link must be open: FunctionFS has its descriptors. Fault::kUnavailable:
    /// the controller is another gadget's, or gone; not prepared for this user. No heap.
    Status bind(const char* controller) noexcept;
    /// The computer sees a pulled cable. No heap.
    Status unbind() noexcept;
    std::string bound_to() const; ///< empty: to none

private:
    GadgetPlaces places_;
};

bool controller_there(const GadgetPlaces& places, const char* controller) noexcept; ///< no heap
/// Of a controller as sysfs has it: "not attached", "configured", "suspended"; "" if it is not there.
std::string controller_state(const GadgetPlaces& places, const std::string& controller);
std::string controller_speed(const GadgetPlaces& places, const std::string& controller); ///< "high-speed"

/// A serial number out of a machine-id: always the same of one board, and not to be turned back. 16 hexadecimal digits;
/// empty: `machine_id` is empty.
std::string serial_of(const std::string& machine_id);

} // namespace dicot
