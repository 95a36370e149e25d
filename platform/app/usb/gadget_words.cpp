#include "gadget_words.h"

#include "dicot/os/small_file.h"

#include <algorithm>
#include <cstdio>

namespace dicot::app {

Result<std::string> serial_for(const UsbConfig& usb, const char* board_number_file, const char* machine_id_file)
{
    if (!usb.serial.empty())
        return usb.serial;
    if (const auto number = read_line(board_number_file)) {
        const std::string_view text = number->view().substr(0, number->view().find('\0')); // as device trees end texts
        if (text.find_first_not_of('0') != std::string_view::npos)
            return serial_of(std::string(text));
    }
    const auto id = read_line(machine_id_file);
    if (!id || id->empty())
        return failure(Fault::kConfig, "%s is not there to make a serial number of: give usb.serial", machine_id_file);
    return serial_of(std::string(id->view()));
}

GadgetWords gadget_words(const std::string& device, const std::string& serial, const char* version)
{
    unsigned major = 0, minor = 0, patch = 0;
    (void)std::sscanf(version, "%u.%u.%u", &major, &minor, &patch);
    GadgetWords words;
    // Binary coded decimals, as USB has them: two digits, one, one.
    words.version_bcd = static_cast<std::uint16_t>((major / 10 % 10) << 12 | major % 10 << 8 |
                                                   std::min(minor, 9U) << 4 | std::min(patch, 9U));
    words.product = "dicot " + device;
    words.serial = serial;
    return words;
}

mtp::DeviceWords device_words(const std::string& device, const std::string& serial, const char* version)
{
    mtp::DeviceWords words;
    words.manufacturer = GadgetWords::kManufacturer;
    words.model = std::string_view("dicot " + device);
    words.version = version;
    words.serial = std::string_view(serial);
    words.name = std::string_view(device);
    return words;
}

} // namespace dicot::app
