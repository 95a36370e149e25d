#include "aio_queue.h"

#include <cerrno>
#include <cstring>
#include <ctime>

#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace dicot::gadget_parts {

AioQueue::~AioQueue()
{
    if (context_ != 0)
        (void)::syscall(SYS_io_destroy, context_);
    if (event_ >= 0)
        ::close(event_);
}

Status AioQueue::open(unsigned most) noexcept
{
    event_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (event_ < 0 || ::syscall(SYS_io_setup, most, &context_) != 0)
        return failure(Fault::kOsError, "the kernel gives no asynchronous transfers (%s): CONFIG_AIO, fs.aio-max-nr",
                       strerrordesc_np(errno));
    return {};
}

void AioQueue::submit(Transfer& transfer) noexcept
{
    transfer.block.aio_flags = IOCB_FLAG_RESFD;
    transfer.block.aio_resfd = static_cast<std::uint32_t>(event_);
    transfer.block.aio_data = reinterpret_cast<std::uintptr_t>(&transfer);
    transfer.under_way = true;
    iocb* list[] = {&transfer.block};
    if (::syscall(SYS_io_submit, context_, 1L, list) == 1)
        return;
    transfer.under_way = false;
    transfer.result = -errno;
}

void AioQueue::read(Transfer& transfer, int descriptor, std::span<std::byte> into) noexcept
{
    transfer.block = {};
    transfer.block.aio_lio_opcode = IOCB_CMD_PREAD;
    transfer.block.aio_fildes = static_cast<std::uint32_t>(descriptor);
    transfer.block.aio_buf = reinterpret_cast<std::uintptr_t>(into.data());
    transfer.block.aio_nbytes = into.size();
    submit(transfer);
}

void AioQueue::write(Transfer& transfer, int descriptor, std::span<const std::byte> from) noexcept
{
    transfer.block = {};
    transfer.block.aio_lio_opcode = IOCB_CMD_PWRITE;
    transfer.block.aio_fildes = static_cast<std::uint32_t>(descriptor);
    transfer.block.aio_buf = reinterpret_cast<std::uintptr_t>(from.data());
    transfer.block.aio_nbytes = from.size();
    submit(transfer);
}

int AioQueue::reap() noexcept
{
    std::uint64_t many = 0;
    (void)!::read(event_, &many, sizeof many);
    int all = 0;
    for (;;) {
        io_event ended[16];
        timespec now{};
        const long count = ::syscall(SYS_io_getevents, context_, 0L, 16L, ended, &now);
        if (count <= 0)
            return all;
        for (long i = 0; i < count; ++i) {
            // The kernel gives back the number that submit() made of the pointer.
            const auto number = static_cast<std::uintptr_t>(ended[i].data);
            auto* transfer = reinterpret_cast<Transfer*>(number); // NOLINT(performance-no-int-to-ptr)
            transfer->under_way = false;
            transfer->result = ended[i].res;
        }
        all += static_cast<int>(count);
    }
}

void AioQueue::cancel(Transfer& transfer) noexcept
{
    io_event ignored;
    if (transfer.under_way)
        (void)::syscall(SYS_io_cancel, context_, &transfer.block, &ignored);
}

} // namespace dicot::gadget_parts
