// Runs a program and counts what goes from the device to the computer meanwhile, by the kernel's own record of the bus
// (usbmon; bus 1 is the gadget's). Once so much went over it does something.
//
//   cable_counter [--at BYTES stop|unbind=FILE] -- PROGRAM WORDS...
//
//   stop         the program is stopped (SIGSTOP) where it is; who wants it to go on sends SIGCONT
//   unbind=FILE  the cable is pulled: FILE is the gadget's "UDC"
//
// Tells on descriptor 3: "at BYTES PID" when that was done, "came BYTES" at the program's end. Its exit code is the
// program's.
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

/// Documentation/usb/usbmon.rst.
struct Header
{
    std::uint64_t id;
    unsigned char type, transfer, endpoint, device;
    std::uint16_t bus;
    char setup_flag, data_flag;
    std::int64_t seconds;
    std::int32_t microseconds, status;
    std::uint32_t length, captured;
    unsigned char rest[24];
};
struct Get
{
    Header* header;
    void* data;
    std::size_t bytes;
};
static_assert(sizeof(Header) == 64);
constexpr unsigned long kGet = _IOW(0x92, 10, Get);
constexpr unsigned char kBulk = 3, kIn = 0x80;

/// A piece of a file (64 KiB) is one transfer to the kernel, and is told of once it ended.
struct Count
{
    std::uint64_t over = 0;

    void take(const Header& header)
    {
        if (header.transfer == kBulk && (header.endpoint & kIn) != 0 && header.type == 'C')
            over += header.length;
    }
    void look(int bus)
    {
        Header header;
        unsigned char data[4];
        const Get get{&header, data, sizeof data};
        while (ioctl(bus, kGet, &get) == 0)
            take(header);
    }
};

bool act(const std::string& what, pid_t program)
{
    if (what == "stop")
        return kill(program, SIGSTOP) == 0;
    const std::string file = what.substr(what.find('=') + 1);
    const int udc = open(file.c_str(), O_WRONLY | O_CLOEXEC);
    const bool written = udc >= 0 && write(udc, "\n", 1) == 1;
    if (!written)
        std::perror(file.c_str());
    close(udc);
    return written;
}

} // namespace

int main(int argc, char** argv)
{
    std::uint64_t wanted = 0;
    std::string what;
    int first = 1;
    if (argc > 4 && std::strcmp(argv[1], "--at") == 0) {
        wanted = std::strtoull(argv[2], nullptr, 10);
        what = argv[3];
        first = 4;
    }
    if (argc < first + 2 || std::strcmp(argv[first], "--") != 0)
        return 64;
    const int bus = open("/dev/usbmon1", O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (bus < 0) {
        std::perror("/dev/usbmon1");
        return 70;
    }
    const pid_t program = fork();
    if (program == 0) {
        close(3);
        execvp(argv[first + 1], argv + first + 1);
        std::perror(argv[first + 1]);
        _exit(70);
    }
    Count count;
    for (int status = 0;;) {
        pollfd events{bus, POLLIN, 0};
        poll(&events, 1, what.empty() ? 20 : 1);
        count.look(bus);
        if (!what.empty() && count.over >= wanted) {
            if (!act(what, program))
                return 70;
            dprintf(3, "at %llu %d\n", static_cast<unsigned long long>(count.over), program);
            what.clear();
        }
        if (waitpid(program, &status, WNOHANG) != program)
            continue;
        count.look(bus);
        dprintf(3, "came %llu\n", static_cast<unsigned long long>(count.over));
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
}
