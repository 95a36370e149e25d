#include "end_server.h"

#include "server_page.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <sys/syscall.h>
#include <unistd.h>

namespace dicot::app {
namespace {

/// The C library has these calls as functions only since 2.36.
int open_process(pid_t process) noexcept
{
    return static_cast<int>(::syscall(SYS_pidfd_open, process, 0U));
}

int send_signal(int process, int signal) noexcept
{
    return static_cast<int>(::syscall(SYS_pidfd_send_signal, process, signal, nullptr, 0U));
}

class OpenProcess
{
public:
    explicit OpenProcess(pid_t process) noexcept : file_(open_process(process)) {}
    OpenProcess(const OpenProcess&) = delete;
    OpenProcess& operator=(const OpenProcess&) = delete;
    ~OpenProcess()
    {
        if (file_ >= 0)
            ::close(file_);
    }
    int file() const noexcept { return file_; }

private:
    int file_;
};

/// Without what the kernel says of a program that an update has replaced.
std::string program_of(const std::string& process)
{
    std::error_code ignored;
    std::string program = std::filesystem::read_symlink("/proc/" + process + "/exe", ignored).string();
    constexpr std::string_view kReplaced = " (deleted)";
    if (program.ends_with(kReplaced))
        program.resize(program.size() - kReplaced.size());
    return program;
}

} // namespace

Result<pid_t> end_server(const std::string& path)
{
    const pid_t server = server_of(path);
    if (server == 0)
        return pid_t{0};
    if (server < 0)
        return failure(Fault::kUnavailable, "%s.lock is held by a process that does not say who it is", path.c_str());
    const int number = static_cast<int>(server);
    const OpenProcess process(server);
    if (process.file() < 0 && errno == ESRCH)
        return server;
    if (process.file() < 0)
        return failure(Fault::kOsError, "process %d cannot be told to end (%s)", number, strerrordesc_np(errno));
    // From here on the number is that of the process that is open, or it has ended and gets no signal.
    if (server_of(path) != server)
        return server;
    const std::string program = program_of(std::to_string(number));
    if (program.empty())
        return failure(Fault::kUnavailable, "process %d serves, and is not this user's to end: run as root", number);
    if (program != program_of("self"))
        return failure(Fault::kUnavailable, "process %d, which holds %s.lock, is %s and no dicot: it is left alone",
                       number, path.c_str(), program.c_str());
    if (send_signal(process.file(), SIGTERM) != 0 && errno != ESRCH)
        return failure(Fault::kUnavailable, "process %d serves, and is not this user's to end: run as root", number);
    return server;
}

} // namespace dicot::app
