// A computer's side of PTP over libusb that may say anything: what it sends, it is told byte by byte. Written from the
// Still Image Capture Device Definition 1.0; knows nothing of dicot's own code, which it tries.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <libusb.h>
#include <string>
#include <vector>

namespace trial {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kGetDeviceInfo = 0x1001, kOpenSession = 0x1002, kCloseSession = 0x1003, kGetStorageIds = 0x1004,
                        kGetObjectHandles = 0x1007, kGetObjectInfo = 0x1008, kGetObject = 0x1009,
                        kSendObjectInfo = 0x100C, kGetPartialObject = 0x101B, kGetPartialObject64 = 0x95C1;
constexpr std::uint16_t kOk = 0x2001, kSessionAlreadyOpen = 0x201E;
constexpr std::uint32_t kEvery = 0xFFFFFFFF;

struct Answer
{
    std::uint16_t code = 0; ///< of the response; 0: there was none
    std::uint64_t data_bytes = 0;
    Bytes data; ///< of its data, the first kMostKept
    static constexpr std::size_t kMostKept = 1 << 20;
};

/// The first device with an interface of class 6 that is not QEMU's own. Ends the program with 1 where there is none.
class StillImage
{
public:
    explicit StillImage(unsigned timeout_ms = 3000);
    ~StillImage();
    StillImage(const StillImage&) = delete;
    StillImage& operator=(const StillImage&) = delete;

    // --- bytes
    int send(const Bytes& bytes, unsigned timeout_ms = 0); ///< libusb's code; 0: all of it went over
    int receive(Bytes& into, std::size_t most, unsigned timeout_ms = 0);
    int control(std::uint8_t type, std::uint8_t request, std::uint16_t value, Bytes& data);
    void drain(unsigned timeout_ms = 50); ///< what the device still wants to say

    // --- containers
    static Bytes container(std::uint16_t type, std::uint16_t code, std::uint32_t transaction,
                           std::initializer_list<std::uint32_t> parameters = {});
    int command(std::uint16_t code, std::initializer_list<std::uint32_t> parameters = {});
    Answer ask(std::uint16_t code, std::initializer_list<std::uint32_t> parameters = {});
    Answer answer(); ///< data, if there are any, and the response

    /// All handles below a folder, asked for as libmtp does; `parent` kEvery: what stands at the top.
    void walk(std::uint32_t storage, std::uint32_t parent, std::vector<std::uint32_t>& into);
    /// The first file of those that are the largest; 0: none.
    std::uint32_t largest(std::uint64_t& bytes);

    // --- ways back
    void cancel(std::uint32_t transaction);
    void device_reset();
    bool reset_and_wait(); ///< until Get Device Status says that it is ready; false: it does not
    int status();          ///< response code of Get Device Status; 0: none
    bool port_reset();
    /// One that stands open from before is as good.
    bool open_session();
    /// As a driver does it that found the device in the middle of anything: clears halts, cancels, resets, drains,
    /// opens a session. False: the device does not answer any more.
    bool recover();

    std::uint32_t transaction = 0; ///< the last one
    std::uint8_t interface = 0, in = 0, out = 0;
    libusb_device_handle* handle = nullptr;

private:
    void open();
    unsigned timeout_ms_;
    libusb_context* context_ = nullptr;
};

std::uint32_t u32_at(const Bytes& bytes, std::size_t at);
std::vector<std::uint32_t> u32_array(const Bytes& bytes);

} // namespace trial
