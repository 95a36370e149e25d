// One page that the process which serves shares with those who ask about it.
#pragma once

#include "dicot/base/status.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <sys/types.h>

namespace dicot::app {

/// Each figure is right by itself; they are not of one moment. The layout is the same on 32 and 64 bits.
struct ServerFigures
{
    static constexpr std::uint64_t kMagic = 0x64696367'61646703; ///< a later layout takes another one

    std::atomic<std::uint64_t> magic{0};
    std::atomic<std::uint64_t> began_us{0};     ///< since 1970, UTC
    std::atomic<std::uint64_t> fixed_bytes{0};  ///< of memory, resident: the most that it can become
    std::atomic<std::uint64_t> session_open{0}; ///< 1: a computer has begun one
    std::atomic<std::uint64_t> sessions{0}, requests{0}, refused{0}, cancelled{0}, objects_sent{0}, bytes_sent{0};
    std::atomic<std::uint64_t> marked{0};
    std::atomic<std::uint64_t> process{0}; ///< who serves
    std::atomic<std::uint64_t> started{0}; ///< when, as /proc/PID/stat has it: numbers are given again
    std::atomic<std::uint64_t> hosts{0}, resets{0}, given_up{0}, events_dropped{0};
};

/// The page, which everybody may read, and beside it its lock, which is its owner's and root's alone: who holds it
/// serves, and the kernel lets go of it when that process ends, however it ends.
class ServerPage
{
public:
    ServerPage() noexcept = default;
    ServerPage(ServerPage&& other) noexcept;
    ServerPage& operator=(ServerPage&& other) noexcept;
    ~ServerPage();

    /// Fault::kTryAgain: another process has it; kUnavailable: this user may not; kOsError.
    static Result<ServerPage> take(const std::string& path);
    ServerFigures& figures() noexcept { return *figures_; }
    Status hand_to(uid_t user, gid_t group) noexcept; ///< by root; the lock stays ours

private:
    int file_ = -1, lock_ = -1;
    ServerFigures* figures_ = nullptr;
};

inline constexpr pid_t kSomebody = -1; ///< who holds the lock in a way that does not tell its process: never a kill()'s
/// Who serves; 0: nobody; or kSomebody. By who may not ask the lock: as the page says. Not by who holds the lock: a
/// look lets go of it.
pid_t server_of(const std::string& path) noexcept;
/// A look at its page. None: nobody serves, or it is another version of this program.
struct SeenServer
{
    pid_t process = 0;
    std::uint64_t began_us, fixed_bytes, session_open, sessions, requests, refused, cancelled, objects_sent, bytes_sent,
        marked, hosts, resets, given_up, events_dropped;
};
std::optional<SeenServer> look_at_server(const std::string& path) noexcept;

} // namespace dicot::app
