#include "guarded_area.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace dicot::proof {

GuardedArea::~GuardedArea()
{
    if (!mapping_.empty())
        ::munmap(mapping_.data(), mapping_.size());
}

Result<GuardedArea> GuardedArea::reserve(std::size_t bytes)
{
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t whole = (bytes + page - 1) / page * page;
    void* const start = ::mmap(nullptr, whole + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED)
        return failure(Fault::kOsError, "The system gives no memory for the proof (%s); close other programs.",
                       std::strerror(errno));
    GuardedArea area;
    area.mapping_ = {static_cast<std::byte*>(start), whole + 2 * page};
    area.usable_ = area.mapping_.subspan(page, whole);
    if (::mprotect(area.usable_.data(), whole, PROT_READ | PROT_WRITE) != 0)
        return failure(Fault::kOsError, "The system gives no memory for the proof (%s); close other programs.",
                       std::strerror(errno));
    return area;
}

} // namespace dicot::proof
