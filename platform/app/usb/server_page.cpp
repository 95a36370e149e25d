#include "server_page.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::size_t kPageBytes = 4096;
static_assert(sizeof(ServerFigures) <= kPageBytes);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

struct flock whole_file(short kind)
{
    struct flock lock
    {
    };
    lock.l_type = kind;
    lock.l_whence = SEEK_SET;
    return lock;
}

std::string lock_of(const std::string& page)
{
    return page + ".lock";
}

/// When a process began, in ticks since the board was switched on (proc(5): field 22); 0: it does not tell.
std::uint64_t start_of(pid_t process) noexcept
{
    char text[1024];
    std::snprintf(text, sizeof text, "/proc/%d/stat", static_cast<int>(process));
    const int file = ::open(text, O_RDONLY | O_CLOEXEC);
    const ssize_t got = file < 0 ? -1 : ::read(file, text, sizeof text - 1);
    if (file >= 0)
        ::close(file);
    if (got <= 0)
        return 0;
    text[got] = '\0';
    // The name in parentheses may hold anything: fields are counted from behind it.
    const char* at = std::strrchr(text, ')');
    for (int field = 2; at != nullptr && field < 22; ++field) {
        at = std::strchr(at, ' ');
        at = at == nullptr ? at : at + 1;
    }
    return at == nullptr ? 0 : std::strtoull(at, nullptr, 10);
}

bool lives(const SeenServer& seen, std::uint64_t started) noexcept
{
    if (const std::uint64_t now = start_of(seen.process); now != 0)
        return now == started;
    return ::kill(seen.process, 0) == 0 || errno == EPERM; // processes of others are hidden here
}

std::optional<SeenServer> read_page(const std::string& path) noexcept
{
    const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0)
        return std::nullopt;
    struct stat told
    {
    };
    void* const at = ::fstat(file, &told) == 0 && told.st_size >= static_cast<off_t>(kPageBytes)
                         ? ::mmap(nullptr, kPageBytes, PROT_READ, MAP_SHARED, file, 0)
                         : MAP_FAILED;
    ::close(file);
    if (at == MAP_FAILED)
        return std::nullopt;
    const auto& page = *static_cast<const ServerFigures*>(at);
    std::optional<SeenServer> seen;
    if (const std::uint64_t process = page.process;
        page.magic == ServerFigures::kMagic && process > 0 && process <= INT32_MAX) {
        seen = SeenServer{static_cast<pid_t>(process),
                          page.began_us,
                          page.fixed_bytes,
                          page.session_open,
                          page.sessions,
                          page.requests,
                          page.refused,
                          page.cancelled,
                          page.objects_sent,
                          page.bytes_sent,
                          page.marked,
                          page.hosts,
                          page.resets,
                          page.given_up,
                          page.events_dropped};
        if (!lives(*seen, page.started))
            seen.reset();
    }
    (void)::munmap(at, kPageBytes);
    return seen;
}

} // namespace

ServerPage::ServerPage(ServerPage&& other) noexcept
    : file_(std::exchange(other.file_, -1)), lock_(std::exchange(other.lock_, -1)),
      figures_(std::exchange(other.figures_, nullptr))
{
}

ServerPage& ServerPage::operator=(ServerPage&& other) noexcept
{
    std::swap(file_, other.file_);
    std::swap(lock_, other.lock_);
    std::swap(figures_, other.figures_);
    return *this;
}

ServerPage::~ServerPage()
{
    if (figures_ != nullptr)
        (void)::munmap(figures_, kPageBytes);
    for (const int each : {file_, lock_})
        if (each >= 0)
            ::close(each);
}

Result<ServerPage> ServerPage::take(const std::string& path)
{
    ServerPage page;
    const std::string lock_path = lock_of(path);
    page.lock_ = ::open(lock_path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (page.lock_ >= 0)
        page.file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (page.file_ < 0)
        return failure(Fault::kUnavailable, "%s cannot be opened (%s): run 'dicot gadget prepare' as root",
                       page.lock_ < 0 ? lock_path.c_str() : path.c_str(), strerrordesc_np(errno));
    struct flock lock = whole_file(F_WRLCK);
    if (::fcntl(page.lock_, F_SETLK, &lock) != 0) {
        if (errno != EAGAIN && errno != EACCES)
            return failure(Fault::kOsError, "%s cannot be locked (%s)", lock_path.c_str(), strerrordesc_np(errno));
        const pid_t server = server_of(path);
        if (server <= 0)
            return failure(Fault::kTryAgain, "%s is locked: another process serves already", lock_path.c_str());
        return failure(Fault::kTryAgain, "process %d serves already: 'dicot gadget down' ends it",
                       static_cast<int>(server));
    }
    // A mask of the service that hides files is not meant for these: everybody may read the one, nobody the other.
    (void)::fchmod(page.lock_, 0600);
    (void)::fchmod(page.file_, 0644);
    void* at = MAP_FAILED;
    if (::ftruncate(page.file_, 0) == 0 && ::ftruncate(page.file_, kPageBytes) == 0)
        at = ::mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_SHARED, page.file_, 0);
    if (at == MAP_FAILED)
        return failure(Fault::kOsError, "%s cannot be mapped (%s)", path.c_str(), strerrordesc_np(errno));
    page.figures_ = ::new (at) ServerFigures;
    page.figures_->process = static_cast<std::uint64_t>(::getpid());
    page.figures_->started = start_of(::getpid());
    return page;
}

Status ServerPage::hand_to(uid_t user, gid_t group) noexcept
{
    for (const int each : {file_, lock_})
        if (::fchown(each, user, group) != 0)
            return failure(Fault::kOsError, "the server's page cannot be handed over (%s)", strerrordesc_np(errno));
    return {};
}

pid_t server_of(const std::string& path) noexcept
{
    const int file = ::open(lock_of(path).c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) {
        const std::optional<SeenServer> seen = errno == EACCES ? read_page(path) : std::nullopt;
        return seen ? seen->process : 0;
    }
    struct flock lock = whole_file(F_WRLCK);
    const bool asked = ::fcntl(file, F_GETLK, &lock) == 0;
    ::close(file);
    if (!asked || lock.l_type == F_UNLCK)
        return 0;
    return lock.l_pid > 0 ? lock.l_pid : kSomebody;
}

std::optional<SeenServer> look_at_server(const std::string& path) noexcept
{
    std::optional<SeenServer> seen = read_page(path);
    if (seen && server_of(path) != seen->process)
        return std::nullopt;
    return seen;
}

} // namespace dicot::app
