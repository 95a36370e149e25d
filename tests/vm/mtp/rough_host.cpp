#include "rough_host.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace trial {

namespace {

constexpr std::uint32_t kStorage = 0x00010001;
constexpr std::size_t kPacket = 512;

struct Rough
{
    StillImage& usb;
    std::vector<std::uint32_t> handles;
    std::uint32_t large = 0; ///< handle of the largest file
    std::uint64_t large_bytes = 0;
};

Bytes blank(std::size_t bytes, std::uint8_t value)
{
    return Bytes(bytes, value);
}

/// A command whose header says something of its own.
Bytes odd(std::uint32_t length, std::uint16_t type, std::uint16_t code, std::size_t bytes)
{
    Bytes it = StillImage::container(type, code, 77, {1, 2, 3, 4, 5});
    for (std::size_t i = 0; i < 4; ++i)
        it[i] = static_cast<std::uint8_t>(length >> (8 * i));
    it.resize(bytes);
    return it;
}

Bytes with_data(std::uint16_t code, std::uint32_t transaction, std::uint32_t length, const Bytes& data)
{
    Bytes it = StillImage::container(2, code, transaction);
    for (std::size_t i = 0; i < 4; ++i)
        it[i] = static_cast<std::uint8_t>(length >> (8 * i));
    it.insert(it.end(), data.begin(), data.end());
    return it;
}

struct Trial
{
    const char* name;
    void (*run)(Rough&);
};

void begin_object(Rough& it)
{
    it.usb.command(kGetObject, {it.large});
}

void class_requests(Rough& it)
{
    for (int request = 0x60; request < 0x70; ++request) {
        for (const std::size_t bytes : {0u, 1u, 4u, 5u, 6u, 7u, 512u}) {
            Bytes data = blank(bytes, 0xFF);
            it.usb.control(0x21, static_cast<std::uint8_t>(request), 0xFFFF, data);
            it.usb.control(0xA1, static_cast<std::uint8_t>(request), 0xFFFF, data);
        }
    }
}

void data_that_lies(Rough& it)
{
    for (const unsigned listed : {0x100Cu, 0x100Du, 0x9804u, 0x9808u, 0x9D02u, 0x9D03u}) {
        const auto code = static_cast<std::uint16_t>(listed);
        for (const std::uint32_t length : {0u, 11u, 12u, 16u, 100u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
            it.usb.command(code, {kStorage, 0});
            it.usb.send(with_data(code, it.usb.transaction, length, blank(88, 0xFF)), 300);
            Bytes answer;
            it.usb.receive(answer, kPacket, 100);
        }
        it.usb.recover();
    }
}

void marks_that_lie(Rough& it)
{
    for (const std::uint32_t count : {0u, 1u, 512u, 513u, 0x0CCCCCCDu, 0xFFFFFFFFu}) {
        Bytes data(4 + 40 * std::min(count, 520u), 0x11);
        for (std::size_t i = 0; i < 4; ++i)
            data[i] = static_cast<std::uint8_t>(count >> (8 * i));
        it.usb.command(0x9D02);
        it.usb.send(with_data(0x9D02, it.usb.transaction, static_cast<std::uint32_t>(data.size() + 12), data), 300);
        it.usb.answer();
    }
}

void every_code(Rough& it)
{
    for (std::uint32_t code = 0x1000; code < 0x1020; ++code)
        it.usb.ask(static_cast<std::uint16_t>(code), {kEvery, kEvery, kEvery, kEvery, kEvery});
    it.usb.ask(kOpenSession, {1});
    for (std::uint32_t code = 0x9800; code < 0x9812; ++code)
        it.usb.ask(static_cast<std::uint16_t>(code), {it.large, kEvery, kEvery, kEvery, kEvery});
    for (std::uint32_t code = 0x95C0; code < 0x95C6; ++code)
        it.usb.ask(static_cast<std::uint16_t>(code), {it.large, kEvery, kEvery, kEvery, kEvery});
}

const Trial kTrials[] = {
    {"lengths that are not true",
     [](Rough& it) {
         for (const std::uint32_t length : {0u, 4u, 11u, 12u, 13u, 31u, 33u, 512u, 0x7FFFFFFFu, 0xFFFFFFFFu})
             it.usb.send(odd(length, 1, kGetDeviceInfo, 32), 300);
     }},
    {"pieces of a header",
     [](Rough& it) {
         for (std::size_t bytes = 1; bytes < 12; ++bytes)
             it.usb.send(odd(static_cast<std::uint32_t>(bytes), 1, kGetDeviceInfo, bytes), 300);
     }},
    {"types that there are not",
     [](Rough& it) {
         for (const std::uint16_t type : std::initializer_list<std::uint16_t>{0, 2, 3, 4, 5, 0xFFFF})
             it.usb.send(odd(32, type, kGetDeviceInfo, 32), 300);
     }},
    {"a command of a packet and more",
     [](Rough& it) {
         for (const std::size_t bytes : {33u, 511u, 512u, 513u, 1024u, 65536u})
             it.usb.send(odd(static_cast<std::uint32_t>(bytes), 1, kGetDeviceInfo, bytes), 300);
     }},
    {"a megabyte of nothing", [](Rough& it) { it.usb.send(blank(1 << 20, 0xFF), 1000); }},
    {"packets of none",
     [](Rough& it) {
         for (int i = 0; i < 200 && it.usb.send({}, 100) == 0; ++i) {
         }
     }},
    {"two sessions, and none",
     [](Rough& it) {
         it.usb.ask(kOpenSession, {1});
         it.usb.ask(kOpenSession, {0});
         it.usb.ask(kCloseSession);
         it.usb.ask(kCloseSession);
         it.usb.ask(kGetObjectHandles, {kEvery, 0, 0});
         it.usb.ask(kGetObject, {it.large});
     }},
    {"every code", every_code},
    {"handles that there are not",
     [](Rough& it) {
         for (const std::uint32_t handle : {0u, 2u, 15u, 16u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFEu, kEvery}) {
             for (const std::uint16_t code : {kGetObjectInfo, kGetObject, kGetPartialObject, std::uint16_t{0x9803}})
                 it.usb.ask(code, {handle, 0, 100});
             it.usb.ask(kGetObjectHandles, {kEvery, 0, handle});
         }
     }},
    {"parts beyond the end",
     [](Rough& it) {
         it.usb.ask(kGetPartialObject, {it.large, 0xFFFFFFFF, 0xFFFFFFFF});
         it.usb.ask(kGetPartialObject, {it.large, static_cast<std::uint32_t>(it.large_bytes) - 1, 0xFFFFFFFF});
         it.usb.ask(kGetPartialObject64, {it.large, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF});
         it.usb.ask(kGetPartialObject64, {it.large, 0, 0x80000000, 1});
         it.usb.ask(kGetPartialObject64, {it.large, 0, 0, 0});
     }},
    {"data that lie about their length", data_that_lies},
    {"marks that lie", marks_that_lie},
    {"data without a command",
     [](Rough& it) {
         it.usb.send(with_data(0x9D02, 1, 100, blank(88, 1)), 300);
         it.usb.send(with_data(kSendObjectInfo, kEvery, 0xFFFFFFFF, blank(500, 1)), 300);
     }},
    {"a command where data should be",
     [](Rough& it) {
         it.usb.command(kSendObjectInfo, {kStorage, 0});
         it.usb.command(kGetDeviceInfo);
         it.usb.command(kSendObjectInfo, {kStorage, 0});
     }},
    {"eight megabytes for an object that may not be",
     [](Rough& it) {
         it.usb.command(kSendObjectInfo, {kStorage, 0});
         const std::size_t bytes = std::size_t{8} << 20;
         const auto length = static_cast<std::uint32_t>(bytes + 12);
         it.usb.send(with_data(kSendObjectInfo, it.usb.transaction, length, blank(bytes, 9)), 10'000);
     }},
    {"class requests of all kinds", class_requests},
    {"cancel before, amid and behind",
     [](Rough& it) {
         it.usb.cancel(it.usb.transaction);
         begin_object(it);
         it.usb.cancel(it.usb.transaction + 5);
         Bytes piece;
         it.usb.receive(piece, 16384);
         it.usb.cancel(it.usb.transaction);
         it.usb.drain();
         it.usb.cancel(it.usb.transaction);
     }},
    {"another command amid an object",
     [](Rough& it) {
         begin_object(it);
         Bytes piece;
         it.usb.receive(piece, kPacket);
         it.usb.send(StillImage::container(1, kGetDeviceInfo, 1), 1000);
         it.usb.send(StillImage::container(1, kGetDeviceInfo, 2), 1000);
     }},
    {"device reset amid an object",
     [](Rough& it) {
         begin_object(it);
         Bytes piece;
         it.usb.receive(piece, 65536);
         it.usb.device_reset();
     }},
    {"port reset amid an object",
     [](Rough& it) {
         begin_object(it);
         Bytes piece;
         it.usb.receive(piece, 65536);
         it.usb.port_reset();
     }},
    {"halts cleared amid an object",
     [](Rough& it) {
         begin_object(it);
         Bytes piece;
         it.usb.receive(piece, 65536);
         libusb_clear_halt(it.usb.handle, it.usb.in);
         libusb_clear_halt(it.usb.handle, it.usb.out);
     }},
    {"deconfigured amid an object",
     [](Rough& it) {
         begin_object(it);
         Bytes piece;
         it.usb.receive(piece, 65536);
         libusb_release_interface(it.usb.handle, it.usb.interface);
         libusb_set_configuration(it.usb.handle, -1);
         usleep(100'000);
         libusb_set_configuration(it.usb.handle, 1);
         libusb_claim_interface(it.usb.handle, it.usb.interface);
     }},
    {"hundreds of questions and no answer taken",
     [](Rough& it) {
         for (std::uint32_t i = 0; i < 400; ++i) {
             if (it.usb.send(StillImage::container(1, kGetDeviceInfo, i), 50) != 0)
                 break;
         }
     }},
    {"whole objects, none of them read",
     [](Rough& it) {
         for (int i = 0; i < 4; ++i) {
             begin_object(it);
             it.usb.device_reset();
         }
     }},
};

/// xorshift64*: the same bytes everywhere.
struct Draw
{
    std::uint64_t state;
    std::uint32_t operator()(std::uint32_t below)
    {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        return static_cast<std::uint32_t>((state * 0x2545F4914F6CDD1D) >> 33) % below;
    }
};

/// A few steps without sense.
void draw_steps(Rough& it, std::uint64_t seed)
{
    Draw draw{seed * 0x9E3779B97F4A7C15 + 1};
    static constexpr std::uint16_t kCodes[] = {0x1001, 0x1002, 0x1003, 0x1004, 0x1005, 0x1006, 0x1007, 0x1008, 0x1009,
                                               0x100C, 0x101B, 0x95C1, 0x9801, 0x9803, 0x9805, 0x9D01, 0x9D02, 0x9D03};
    Bytes piece;
    for (int step = 0; step < 6; ++step) {
        const std::uint16_t code = kCodes[draw(std::size(kCodes))];
        const auto parameter = [&] {
            return draw(2) != 0 ? it.handles[draw(static_cast<std::uint32_t>(it.handles.size()))] : draw(64);
        };
        switch (draw(8)) {
        case 0:
        case 1:
        case 2:
            it.usb.command(code, {parameter(), parameter(), draw(70'000), draw(70'000)});
            break;
        case 3:
            it.usb.receive(piece, kPacket * (1 + draw(64)), 100);
            break;
        case 4:
            it.usb.send(with_data(code, it.usb.transaction, draw(5000), blank(draw(5000), 3)), 200);
            break;
        case 5:
            it.usb.cancel(it.usb.transaction - draw(2));
            break;
        case 6:
            it.usb.device_reset();
            break;
        default:
            it.usb.send(odd(draw(600), static_cast<std::uint16_t>(draw(5)), code, 1 + draw(600)), 200);
            break;
        }
    }
}

bool look(Rough& it)
{
    const Answer all = it.usb.ask(kGetObjectHandles, {kEvery, 0, 0});
    it.handles = u32_array(all.data);
    return all.code == kOk && !it.handles.empty();
}

/// The same objects, and one of them whole.
bool is_as_before(Rough& it)
{
    const std::vector<std::uint32_t> before = it.handles;
    if (!it.usb.recover() && !(it.usb.port_reset() && it.usb.recover())) {
        std::printf("    it does not come back\n");
        return false;
    }
    if (!look(it) || it.handles != before) {
        std::printf("    it shows %zu objects and not %zu\n", it.handles.size(), before.size());
        return false;
    }
    const Answer part = it.usb.ask(kGetPartialObject, {it.large, 0, 4096});
    if (part.code != kOk || part.data_bytes != std::min<std::uint64_t>(4096, it.large_bytes)) {
        std::printf("    it gives %llu bytes and says %04x\n", static_cast<unsigned long long>(part.data_bytes),
                    part.code);
        return false;
    }
    return true;
}

} // namespace

bool be_hostile(StillImage& device, std::uint64_t seed, int count)
{
    Rough it{device, {}, 0, 0};
    if (!device.recover() || !look(it) || (it.large = device.largest(it.large_bytes)) == 0) {
        std::printf("it does not answer to begin with\n");
        return false;
    }
    bool good = true;
    for (const Trial& trial : kTrials) {
        std::printf("%s\n", trial.name);
        std::fflush(stdout);
        trial.run(it);
        good = is_as_before(it) && good;
    }
    for (int i = 0; i < count; ++i) {
        const std::uint64_t drawn = seed + static_cast<std::uint64_t>(i);
        draw_steps(it, drawn);
        if (!is_as_before(it)) {
            std::printf("    that was what seed %llu draws\n", static_cast<unsigned long long>(drawn));
            good = false;
        }
    }
    return good;
}

} // namespace trial
