#include "endpoints.h"

#include "descriptors.h"

#include "dicot/os/small_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace dicot::gadget_parts {
namespace {

constexpr unsigned kUsualPacket = 512;

/// 0, or the errno.
int hand_over(int control, std::span<const std::byte> bytes) noexcept
{
    const ssize_t written = ::write(control, bytes.data(), bytes.size());
    if (written < 0)
        return errno;
    return static_cast<std::size_t>(written) == bytes.size() ? 0 : EIO;
}

Result<Descriptor> open_one(const char* mount, int number) noexcept
{
    const JoinedPath path("%s/ep%d", mount, number);
    const int opened = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (opened >= 0)
        return Descriptor(opened);
    const int why = errno;
    if (why == ENOENT)
        return failure(Fault::kUnavailable, "%s is not there: run 'dicot gadget prepare' as root", path.c_str());
    if (why == EACCES || why == EPERM)
        return failure(Fault::kUnavailable,
                       "%s is not this user's: 'dicot gadget prepare' as root hands it to who is to serve",
                       path.c_str());
    return failure(Fault::kUnavailable, "%s cannot be opened (%s)", path.c_str(), strerrordesc_np(why));
}

} // namespace

Descriptor::~Descriptor()
{
    if (number_ >= 0)
        ::close(number_);
}

Result<Endpoints> Endpoints::open(const char* mount) noexcept
{
    Endpoints opened;
    opened.control = TRY(open_one(mount, 0));
    const int control = opened.control.get();
    int why = hand_over(control, DescriptorBlock(0x0100).bytes());
    if (why == EINVAL)
        why = hand_over(control, DescriptorBlock(0x0001).bytes());
    if (why == ESRCH || why == EBUSY || why == EIDRM)
        return failure(Fault::kTryAgain, "%s: another process serves it", mount);
    if (why != 0)
        return failure(Fault::kOsError, "%s: the kernel refuses our descriptors (%s)", mount, strerrordesc_np(why));
    if (why = hand_over(control, interface_string()); why != 0)
        return failure(Fault::kOsError, "%s: the kernel refuses our strings (%s)", mount, strerrordesc_np(why));
    opened.to_host = TRY(open_one(mount, 1));
    opened.from_host = TRY(open_one(mount, 2));
    opened.events = TRY(open_one(mount, 3));
    return opened;
}

unsigned Endpoints::packet_bytes() const noexcept
{
    usb_endpoint_descriptor told{};
    if (::ioctl(to_host.get(), FUNCTIONFS_ENDPOINT_DESC, &told) != 0)
        return kUsualPacket;
    const unsigned bytes = told.wMaxPacketSize; // little-endian, as every processor that this is built for
    return bytes == 0 ? kUsualPacket : bytes;
}

void Endpoints::discard_unread() const noexcept
{
    (void)::ioctl(to_host.get(), FUNCTIONFS_FIFO_FLUSH);
}

} // namespace dicot::gadget_parts
