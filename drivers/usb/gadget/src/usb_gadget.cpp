#include "dicot/gadget/usb_gadget.h"

#include "kernel_parts.h"

#include "dicot/os/sha256.h"
#include "dicot/os/small_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <span>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using namespace gadget_parts;

constexpr const char* kFunction = "functions/ffs.dicot";
constexpr const char* kConfiguration = "configs/c.1";
constexpr const char* kStrings = "strings/0x409"; // English
constexpr const char* kHint = "what each board needs is in /usr/share/doc/dicot/README.Debian";

Status refused(const std::string& path, const char* what, int why)
{
    return failure(why == EACCES || why == EPERM ? Fault::kUnavailable : Fault::kOsError, "%s: %s (%s)", path.c_str(),
                   what, why == EACCES || why == EPERM ? "run as root" : strerrordesc_np(why));
}

Status make_folders(const std::string& path)
{
    std::error_code why;
    fs::create_directories(path, why);
    if (why)
        return refused(path, "cannot be made", why.value());
    return {};
}

/// configfs knows its own files alone: O_CREAT is for a folder of a test.
Status set(const std::string& path, const std::string& value)
{
    const int opened = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (opened < 0)
        return refused(path, "cannot be written", errno);
    const ssize_t written = ::write(opened, value.data(), value.size());
    const int why = written < 0 ? errno : 0;
    ::close(opened);
    if (why != 0)
        return refused(path, "is refused by the kernel", why);
    return {};
}

Status link_to(const std::string& target, const std::string& link)
{
    std::error_code why;
    if (fs::is_symlink(link, why))
        return {};
    fs::create_symlink(target, link, why);
    if (why)
        return refused(link, "cannot be linked", why.value());
    return {};
}

/// Not there is as good.
Status take_away(const std::string& path)
{
    if (std::error_code ignored; !fs::exists(fs::symlink_status(path, ignored)))
        return {};
    std::error_code why;
    fs::remove(path, why);
    if (why)
        return refused(path, "cannot be removed", why.value());
    return {};
}

std::string hex16(std::uint16_t value)
{
    char text[8];
    std::snprintf(text, sizeof text, "0x%04x", unsigned{value});
    return text;
}

} // namespace

Result<std::string> UsbGadget::controller(const std::string& wanted) const
{
    std::vector<std::string> names;
    std::error_code why;
    for (fs::directory_iterator each(places_.controllers, why), end; !why && each != end; each.increment(why))
        names.push_back(each->path().filename().string());
    std::sort(names.begin(), names.end());
    if (names.empty())
        return failure(Fault::kUnavailable,
                       "this board has no USB device port, or it is not switched to be one (on a Raspberry Pi: "
                       "dtoverlay=dwc2,dr_mode=peripheral): %s",
                       kHint);
    if (wanted.empty())
        return names.front();
    if (std::find(names.begin(), names.end(), wanted) != names.end())
        return wanted;
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : ", ") + name;
    return failure(Fault::kUnavailable, "usb.udc is %s, and this board has %s: give one of these, or \"\"",
                   wanted.c_str(), all.c_str());
}

Status UsbGadget::make(const GadgetWords& words) const
{
    const std::string gadget = places_.gadget();
    const std::string configuration = gadget + "/" + kConfiguration;
    const std::string strings = gadget + "/" + kStrings;
    const std::string function = gadget + "/" + kFunction;
    for (const std::string& folder : {gadget, strings, configuration + "/" + kStrings, function, gadget + "/os_desc"})
        TRY(make_folders(folder));
    // A board that has a supply of its own, whatever this port gives: a hub without one takes it, too.
    const std::pair<std::string, std::string> values[] = {
        {gadget + "/idVendor", hex16(GadgetWords::kVendor)},
        {gadget + "/idProduct", hex16(GadgetWords::kProduct)},
        {gadget + "/bcdDevice", hex16(words.version_bcd)},
        {gadget + "/bcdUSB", "0x0200"},
        {strings + "/manufacturer", GadgetWords::kManufacturer},
        {strings + "/product", words.product},
        {strings + "/serialnumber", words.serial},
        {configuration + "/" + kStrings + "/configuration", "MTP"},
        {configuration + "/bmAttributes", "0xc0"},
        {configuration + "/MaxPower", "100"},
        {gadget + "/os_desc/use", "1"},
        {gadget + "/os_desc/b_vendor_code", "0x01"},
        {gadget + "/os_desc/qw_sign", "MSFT100"},
    };
    for (const auto& [path, value] : values)
        TRY(set(path, value));
    TRY(link_to(function, configuration + "/ffs.dicot"));
    return link_to(configuration, gadget + "/os_desc/c.1");
}

Status UsbGadget::prepare(const GadgetWords& words, uid_t user, gid_t group)
{
    TRY(provide_configfs(places_.config));
    if (there())
        TRY(remove()); // strings of another configuration, a function that lost its process
    TRY(make(words));
    TRY(make_run_folder());
    TRY(unmount_functionfs(places_.mount()));
    TRY(own_folder(places_.mount()));
    TRY(mount_functionfs("dicot", places_.mount(), user, group));
    const std::string port = places_.gadget() + "/UDC";
    if (::lchown(port.c_str(), user, group) != 0)
        return refused(port, "cannot be handed over", errno);
    return {};
}

Status UsbGadget::make_run_folder() const
{
    return own_folder(places_.run);
}

bool UsbGadget::there() const
{
    std::error_code ignored;
    return fs::exists(places_.gadget(), ignored);
}

bool UsbGadget::prepared() const
{
    return is_functionfs(places_.mount());
}

Status UsbGadget::remove()
{
    if (!bound_to().empty())
        TRY(unbind());
    TRY(unmount_functionfs(places_.mount()));
    const std::string gadget = places_.gadget() + "/";
    const std::string configuration = gadget + kConfiguration;
    // What others point at goes after them.
    for (const std::string& path :
         {gadget + "os_desc/c.1", configuration + "/ffs.dicot", configuration + "/" + kStrings, configuration,
          gadget + kFunction, gadget + kStrings, places_.gadget(), places_.mount()})
        TRY(take_away(path));
    return {};
}

Status UsbGadget::bind(const char* controller) noexcept
{
    const JoinedPath path("%s/usb_gadget/dicot/UDC", places_.config.c_str());
    const JoinedPath line("%s\n", controller);
    const int why = write_line(path.c_str(), line.c_str());
    switch (why) {
    case 0:
        return {};
    case EBUSY:
        return failure(Fault::kTryAgain,
                       "the USB device port %s is used by another gadget (g_ether and the like): unload it, or give "
                       "usb.udc another one",
                       controller);
    case ENODEV:
        return failure(Fault::kUnavailable, "the USB device port %s has gone", controller);
    case EACCES:
    case ENOENT:
        return failure(Fault::kUnavailable, "%s: not handed to this user: run 'dicot gadget prepare' as root",
                       path.c_str());
    default:
        return failure(Fault::kOsError, "the kernel does not bind the gadget to %s (%s)", controller,
                       strerrordesc_np(why));
    }
}

Status UsbGadget::unbind() noexcept
{
    const JoinedPath path("%s/usb_gadget/dicot/UDC", places_.config.c_str());
    const int why = write_line(path.c_str(), "\n");
    if (why == 0 || why == ENODEV || why == ENOENT) // ENODEV: it was bound to none
        return {};
    return failure(Fault::kOsError, "%s: the gadget cannot be unbound (%s)", path.c_str(), strerrordesc_np(why));
}

std::string UsbGadget::bound_to() const
{
    const auto line = read_line((places_.gadget() + "/UDC").c_str());
    return line ? std::string(line->view()) : std::string();
}

bool controller_there(const GadgetPlaces& places, const char* controller) noexcept
{
    return ::access(JoinedPath("%s/%s", places.controllers.c_str(), controller).c_str(), F_OK) == 0;
}

std::string controller_state(const GadgetPlaces& places, const std::string& controller)
{
    const auto line = read_line((places.controllers + "/" + controller + "/state").c_str());
    return line ? std::string(line->view()) : std::string();
}

std::string controller_speed(const GadgetPlaces& places, const std::string& controller)
{
    const auto line = read_line((places.controllers + "/" + controller + "/current_speed").c_str());
    return line ? std::string(line->view()) : std::string();
}

std::string serial_of(const std::string& machine_id)
{
    if (machine_id.empty())
        return {};
    const std::string whole = "dicot usb serial " + machine_id;
    return std::string(hex_of(sha256_of(std::as_bytes(std::span(whole)))).data(), 16);
}

} // namespace dicot
