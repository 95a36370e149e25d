#include "server_page.h"

#include <cerrno>
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

} // namespace

ServerPage::ServerPage(ServerPage&& other) noexcept
    : file_(std::exchange(other.file_, -1)), figures_(std::exchange(other.figures_, nullptr))
{
}

ServerPage& ServerPage::operator=(ServerPage&& other) noexcept
{
    std::swap(file_, other.file_);
    std::swap(figures_, other.figures_);
    return *this;
}

ServerPage::~ServerPage()
{
    if (figures_ != nullptr)
        (void)::munmap(figures_, kPageBytes);
    if (file_ >= 0)
        ::close(file_);
}

Result<ServerPage> ServerPage::take(const std::string& path)
{
    ServerPage page;
    page.file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (page.file_ < 0)
        return failure(Fault::kUnavailable, "%s cannot be opened (%s): run 'dicot gadget prepare' as root",
                       path.c_str(), strerrordesc_np(errno));
    struct flock lock = whole_file(F_WRLCK);
    if (::fcntl(page.file_, F_SETLK, &lock) != 0) {
        if (errno == EAGAIN || errno == EACCES)
            return failure(Fault::kTryAgain, "process %d serves already: 'dicot gadget down' ends it",
                           static_cast<int>(server_of(path)));
        return failure(Fault::kOsError, "%s cannot be locked (%s)", path.c_str(), strerrordesc_np(errno));
    }
    void* at = MAP_FAILED;
    if (::ftruncate(page.file_, 0) == 0 && ::ftruncate(page.file_, kPageBytes) == 0)
        at = ::mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_SHARED, page.file_, 0);
    if (at == MAP_FAILED)
        return failure(Fault::kOsError, "%s cannot be mapped (%s)", path.c_str(), strerrordesc_np(errno));
    page.figures_ = ::new (at) ServerFigures;
    return page;
}

Status ServerPage::hand_to(uid_t user, gid_t group) noexcept
{
    if (::fchown(file_, user, group) != 0)
        return failure(Fault::kOsError, "the server's page cannot be handed over (%s)", strerrordesc_np(errno));
    return {};
}

pid_t server_of(const std::string& path) noexcept
{
    const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0)
        return 0;
    struct flock lock = whole_file(F_WRLCK);
    const bool asked = ::fcntl(file, F_GETLK, &lock) == 0;
    ::close(file);
    return asked && lock.l_type != F_UNLCK ? lock.l_pid : 0;
}

std::optional<SeenServer> look_at_server(const std::string& path) noexcept
{
    const pid_t process = server_of(path);
    const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0)
        return std::nullopt;
    struct stat told
    {
    };
    void* const at = process > 0 && ::fstat(file, &told) == 0 && told.st_size >= static_cast<off_t>(kPageBytes)
                         ? ::mmap(nullptr, kPageBytes, PROT_READ, MAP_SHARED, file, 0)
                         : MAP_FAILED;
    ::close(file);
    if (at == MAP_FAILED)
        return std::nullopt;
    const auto& page = *static_cast<const ServerFigures*>(at);
    std::optional<SeenServer> seen;
    if (page.magic == ServerFigures::kMagic)
        seen = SeenServer{process,       page.began_us, page.fixed_bytes, page.session_open, page.sessions,
                          page.requests, page.refused,  page.cancelled,   page.objects_sent, page.bytes_sent,
                          page.marked,   page.hosts,    page.resets,      page.given_up,     page.events_dropped};
    (void)::munmap(at, kPageBytes);
    return seen;
}

} // namespace dicot::app
