#include "dicot/mtp_host/mtp_list.h"

#include "usb_files.h"

#include "dicot/base/printable.h"
#include "dicot/mtp/data_reader.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <unistd.h>

namespace dicot::mtp {
namespace {

constexpr std::size_t kDeviceDescriptor = 18;
constexpr std::size_t kMostDescriptorBytes = kDeviceDescriptor + 65535;
enum Descriptor : std::uint8_t
{
    kConfiguration = 2,
    kInterface = 4,
    kEndpoint = 5,
};
constexpr unsigned kBulk = 2, kInterrupt = 3; ///< bmAttributes, the lowest two bits

unsigned byte_at(std::span<const std::byte> bytes, std::size_t at)
{
    return std::to_integer<unsigned>(bytes[at]);
}

/// One interface as its descriptors go by (USB 2.0, clause 9.6).
struct Candidate
{
    MtpListed ends;
    bool likely = false, of_vendor = false;

    void begin(std::span<const std::byte> interface, std::uint8_t configuration)
    {
        *this = {};
        ends.configuration = configuration;
        ends.interface = static_cast<std::uint8_t>(byte_at(interface, 2));
        ends.alternate = static_cast<std::uint8_t>(byte_at(interface, 3));
        const unsigned what = byte_at(interface, 5) << 16 | byte_at(interface, 6) << 8 | byte_at(interface, 7);
        of_vendor = byte_at(interface, 5) == 0xFF;
        likely = what == 0x060101 || of_vendor;
    }
    void add(std::span<const std::byte> endpoint)
    {
        const auto address = static_cast<std::uint8_t>(byte_at(endpoint, 2));
        const unsigned kind = byte_at(endpoint, 3) & 3;
        const bool in = (address & 0x80) != 0;
        const unsigned packet = (byte_at(endpoint, 4) | byte_at(endpoint, 5) << 8) & 0x7FF;
        if (kind == kInterrupt && in && ends.events == 0)
            ends.events = address;
        if (kind != kBulk)
            return;
        std::uint8_t& end = in ? ends.bulk_in : ends.bulk_out;
        // Two pipes of one direction, or packets that no bulk endpoint has: not MTP.
        likely = likely && end == 0 && packet >= 8 && packet <= 1024 && (packet & (packet - 1)) == 0 &&
                 (ends.packet_bytes == 0 || ends.packet_bytes == packet);
        end = address;
        ends.packet_bytes = static_cast<std::uint16_t>(packet);
    }
    bool fits(bool (*is_called_mtp)(void*, std::uint8_t), void* asker) const
    {
        if (!likely || ends.bulk_in == 0 || ends.bulk_out == 0)
            return false;
        return !of_vendor || (ends.events != 0 && is_called_mtp(asker, ends.interface));
    }
    void tell(MtpListed& listed) const
    {
        listed.configuration = ends.configuration;
        listed.interface = ends.interface;
        listed.alternate = ends.alternate;
        listed.bulk_out = ends.bulk_out;
        listed.bulk_in = ends.bulk_in;
        listed.events = ends.events;
        listed.packet_bytes = ends.packet_bytes;
    }
};

struct AskFiles
{
    const char* folder;
    const std::string& port;
    int configuration;
};

bool is_called_mtp_in_files(void* asker, std::uint8_t interface)
{
    const AskFiles& ask = *static_cast<AskFiles*>(asker);
    char name[64];
    std::snprintf(name, sizeof name, "%.31s:%d.%d", ask.port.c_str(), ask.configuration, interface);
    return usb_line(ask.folder, name, "interface").find("MTP") != std::string::npos;
}

bool look_at(const char* folder, const std::string& port, std::span<std::byte> room, MtpListed& listed)
{
    const auto descriptors = usb_bytes(folder, port, "descriptors", room);
    const int configuration = usb_number(folder, port, "bConfigurationValue");
    AskFiles asker{folder, port, configuration};
    if (configuration < 1 || configuration > 255 ||
        !find_mtp_interface(descriptors, static_cast<std::uint8_t>(configuration), is_called_mtp_in_files, &asker,
                            listed))
        return false;
    DataReader device(descriptors.subspan(8));
    listed.vendor_id = device.u16();
    listed.product_id = device.u16();
    listed.port = std::string_view{port};
    listed.manufacturer = printable<63>(usb_line(folder, port, "manufacturer"));
    listed.product = printable<63>(usb_line(folder, port, "product"));
    listed.serial = printable<63>(usb_line(folder, port, "serial"));
    listed.bus = usb_number(folder, port, "busnum");
    listed.address = usb_number(folder, port, "devnum");
    char file[64];
    std::snprintf(file, sizeof file, "/dev/bus/usb/%03d/%03d", listed.bus, listed.address);
    listed.may_open = ::access(file, R_OK | W_OK) == 0;
    return true;
}

} // namespace

bool find_mtp_interface(std::span<const std::byte> descriptors, std::uint8_t active_configuration,
                        bool (*is_called_mtp)(void* asker, std::uint8_t interface), void* asker, MtpListed& listed)
{
    Candidate candidate;
    unsigned configuration = 0;
    for (std::size_t at = kDeviceDescriptor; at + 2 <= descriptors.size();) {
        const std::size_t length = byte_at(descriptors, at);
        if (length < 2 || length > descriptors.size() - at)
            break;
        const auto one = descriptors.subspan(at, length);
        const unsigned kind = byte_at(one, 1);
        at += length;
        if (kind == kConfiguration || kind == kInterface) {
            if (candidate.fits(is_called_mtp, asker))
                break;
            candidate = {};
        }
        if (kind == kConfiguration && length >= 9)
            configuration = byte_at(one, 5);
        if (configuration != active_configuration)
            continue;
        if (kind == kInterface && length >= 9)
            candidate.begin(one, active_configuration);
        if (kind == kEndpoint && length >= 7)
            candidate.add(one);
    }
    if (!candidate.fits(is_called_mtp, asker))
        return false;
    candidate.tell(listed);
    return true;
}

Result<std::vector<MtpListed>> list_mtp_devices(const char* folder)
{
    std::vector<std::string> ports;
    if (!usb_ports(folder, ports))
        return failure(Fault::kUnavailable, "%s: this system lists no USB devices; is USB in its kernel?", folder);
    const auto room = std::make_unique_for_overwrite<std::byte[]>(kMostDescriptorBytes);
    std::vector<MtpListed> devices;
    for (const std::string& port : ports) {
        MtpListed listed;
        if (look_at(folder, port, {room.get(), kMostDescriptorBytes}, listed))
            devices.push_back(listed);
    }
    return devices;
}

} // namespace dicot::mtp
