#include "still_image.h"

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

namespace trial {

namespace {

constexpr std::uint16_t kQemu = 0x46f4;
constexpr std::size_t kHeader = 12, kPieces = 65536, kMostWalked = 100'000;
constexpr std::uint16_t kFolder = 0x3001;

void put(Bytes& into, std::uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; ++i)
        into.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

bool find_interface(libusb_device* device, StillImage& into)
{
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(device, &config) != 0)
        return false;
    bool found = false;
    for (int i = 0; i < config->bNumInterfaces && !found; ++i) {
        const libusb_interface_descriptor& it = config->interface[i].altsetting[0];
        if (it.bInterfaceClass != LIBUSB_CLASS_IMAGE && it.bInterfaceClass != LIBUSB_CLASS_VENDOR_SPEC)
            continue;
        into.interface = it.bInterfaceNumber;
        into.in = into.out = 0;
        for (int e = 0; e < it.bNumEndpoints; ++e) {
            const libusb_endpoint_descriptor& endpoint = it.endpoint[e];
            if ((endpoint.bmAttributes & 3) != LIBUSB_TRANSFER_TYPE_BULK)
                continue;
            ((endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0 ? into.in : into.out) = endpoint.bEndpointAddress;
        }
        found = into.in != 0 && into.out != 0;
    }
    libusb_free_config_descriptor(config);
    return found;
}

} // namespace

std::uint32_t u32_at(const Bytes& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
        value |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    return value;
}

std::vector<std::uint32_t> u32_array(const Bytes& bytes)
{
    std::vector<std::uint32_t> into;
    for (std::size_t i = 0; i < u32_at(bytes, 0) && 4 * i + 8 <= bytes.size(); ++i)
        into.push_back(u32_at(bytes, 4 * i + 4));
    return into;
}

StillImage::StillImage(unsigned timeout_ms) : timeout_ms_(timeout_ms)
{
    if (libusb_init(&context_) != 0)
        std::exit(1);
    open();
}

StillImage::~StillImage()
{
    libusb_release_interface(handle, interface);
    libusb_close(handle);
    libusb_exit(context_);
}

void StillImage::open()
{
    // It may be about to come back.
    for (int attempt = 0; attempt < 100; ++attempt, usleep(100'000)) {
        libusb_device** list = nullptr;
        const ssize_t count = libusb_get_device_list(context_, &list);
        for (ssize_t i = 0; i < count && handle == nullptr; ++i) {
            libusb_device_descriptor descriptor;
            if (libusb_get_device_descriptor(list[i], &descriptor) != 0 || descriptor.idVendor == kQemu)
                continue;
            if (!find_interface(list[i], *this) || libusb_open(list[i], &handle) != 0)
                handle = nullptr;
        }
        libusb_free_device_list(list, 1);
        if (handle != nullptr && libusb_claim_interface(handle, interface) == 0)
            return;
        if (handle != nullptr)
            libusb_close(handle);
        handle = nullptr;
    }
    std::printf("no device to be opened\n");
    std::exit(1);
}

int StillImage::send(const Bytes& bytes, unsigned timeout_ms)
{
    int sent = 0;
    const int code =
        libusb_bulk_transfer(handle, out, const_cast<std::uint8_t*>(bytes.data()), static_cast<int>(bytes.size()),
                             &sent, timeout_ms != 0 ? timeout_ms : timeout_ms_);
    return code == 0 && sent != static_cast<int>(bytes.size()) ? LIBUSB_ERROR_OTHER : code;
}

int StillImage::receive(Bytes& into, std::size_t most, unsigned timeout_ms)
{
    into.resize(most);
    int got = 0;
    const int code = libusb_bulk_transfer(handle, in, into.data(), static_cast<int>(most), &got,
                                          timeout_ms != 0 ? timeout_ms : timeout_ms_);
    into.resize(static_cast<std::size_t>(got));
    return code;
}

int StillImage::control(std::uint8_t type, std::uint8_t request, std::uint16_t value, Bytes& data)
{
    return libusb_control_transfer(handle, type, request, value, interface, data.data(),
                                   static_cast<std::uint16_t>(data.size()), timeout_ms_);
}

void StillImage::drain(unsigned timeout_ms)
{
    Bytes piece;
    while (receive(piece, kPieces, timeout_ms) == 0) {
    }
}

Bytes StillImage::container(std::uint16_t type, std::uint16_t code, std::uint32_t transaction,
                            std::initializer_list<std::uint32_t> parameters)
{
    Bytes bytes;
    put(bytes, static_cast<std::uint32_t>(kHeader + 4 * parameters.size()), 4);
    put(bytes, type, 2);
    put(bytes, code, 2);
    put(bytes, transaction, 4);
    for (const std::uint32_t parameter : parameters)
        put(bytes, parameter, 4);
    return bytes;
}

int StillImage::command(std::uint16_t code, std::initializer_list<std::uint32_t> parameters)
{
    return send(container(1, code, code == kOpenSession ? 0 : ++transaction, parameters));
}

Answer StillImage::ask(std::uint16_t code, std::initializer_list<std::uint32_t> parameters)
{
    return command(code, parameters) == 0 ? answer() : Answer{};
}

Answer StillImage::answer()
{
    Answer answer;
    Bytes piece;
    while (receive(piece, kPieces) == 0) {
        if (piece.empty())
            continue;
        const unsigned type = piece.size() >= kHeader ? piece[4] : 0u;
        if (type == 3) {
            answer.code = static_cast<std::uint16_t>(piece[6] | piece[7] << 8);
            return answer;
        }
        if (type != 2)
            return answer;
        // To the end of the transfer: a piece that is not full.
        answer.data.assign(piece.begin() + kHeader, piece.end());
        answer.data_bytes = piece.size() - kHeader;
        while (piece.size() == kPieces && receive(piece, kPieces) == 0) {
            answer.data_bytes += piece.size();
            if (answer.data.size() < Answer::kMostKept)
                answer.data.insert(answer.data.end(), piece.begin(), piece.end());
        }
    }
    return answer;
}

void StillImage::walk(std::uint32_t storage, std::uint32_t parent, std::vector<std::uint32_t>& into)
{
    for (const std::uint32_t child : u32_array(ask(kGetObjectHandles, {storage, 0, parent}).data)) {
        into.push_back(child);
        const Bytes info = ask(kGetObjectInfo, {child}).data;
        if ((u32_at(info, 4) & 0xFFFF) == kFolder && into.size() < kMostWalked)
            walk(storage, child, into);
    }
}

std::uint32_t StillImage::largest(std::uint64_t& bytes)
{
    const std::vector<std::uint32_t> storages = u32_array(ask(kGetStorageIds).data);
    std::vector<std::uint32_t> all;
    if (!storages.empty())
        walk(storages.front(), kEvery, all);
    std::uint32_t largest = 0;
    bytes = 0;
    for (const std::uint32_t one : all) {
        const Bytes info = ask(kGetObjectInfo, {one}).data;
        if ((u32_at(info, 4) & 0xFFFF) == kFolder || u32_at(info, 8) <= bytes)
            continue;
        bytes = u32_at(info, 8);
        largest = one;
    }
    return largest;
}

void StillImage::cancel(std::uint32_t cancelled)
{
    Bytes data;
    put(data, 0x4001, 2);
    put(data, cancelled, 4);
    control(0x21, 0x64, 0, data);
}

void StillImage::device_reset()
{
    Bytes none;
    control(0x21, 0x66, 0, none);
}

bool StillImage::reset_and_wait()
{
    device_reset();
    for (int i = 0; i < 50; ++i, usleep(20'000)) {
        if (status() == kOk)
            return true;
    }
    return false;
}

int StillImage::status()
{
    Bytes data(32);
    const int got = control(0xA1, 0x67, 0, data);
    return got >= 4 ? data[2] | data[3] << 8 : 0;
}

bool StillImage::port_reset()
{
    const int code = libusb_reset_device(handle);
    if (code == 0)
        return true;
    libusb_close(handle);
    handle = nullptr;
    open();
    return code == LIBUSB_ERROR_NOT_FOUND;
}

bool StillImage::open_session()
{
    const std::uint16_t code = ask(kOpenSession, {1}).code;
    return code == kOk || code == kSessionAlreadyOpen;
}

bool StillImage::recover()
{
    for (int attempt = 0; attempt < 5; ++attempt) {
        libusb_clear_halt(handle, in);
        libusb_clear_halt(handle, out);
        device_reset();
        drain();
        for (int i = 0; i < 50 && status() != kOk; ++i)
            usleep(20'000);
        drain();
        if (ask(kGetDeviceInfo).code == kOk && open_session())
            return true;
    }
    return false;
}

} // namespace trial
