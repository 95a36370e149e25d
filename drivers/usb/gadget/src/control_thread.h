// Who answers endpoint 0, always at once.
#pragma once

#include "still_image.h"

#include "dicot/base/status.h"
#include "dicot/gadget/ffs_link.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <pthread.h>

namespace dicot::gadget_parts {

/// What both threads know, behind `lock`.
struct SharedCable
{
    std::mutex lock;
    std::condition_variable flushed; ///< image.must_flush() has become false
    StillImage image;
    CableCounts counts;
    int wake = -1; ///< eventfd: something has changed
};

/// Reads events and requests until it is let go. The kernel's events post, the responder's thread decides.
class ControlThread
{
public:
    ControlThread() noexcept = default;
    ControlThread(const ControlThread&) = delete;
    ControlThread& operator=(const ControlThread&) = delete;
    /// Ends it, also out of a request whose data do not come.
    ~ControlThread();

    /// `control`: FunctionFS's ep0. Fault::kOsError: no thread.
    Status start(int control, SharedCable& cable) noexcept;

private:
    static void* enter(void* self) noexcept;
    void run() noexcept;
    void read_event() noexcept;
    void answer(const Setup& setup) noexcept;
    void acknowledge_reset(const Setup& setup) noexcept;
    void stall(const Setup& setup) noexcept;
    void tell() noexcept;

    int control_ = -1, stop_ = -1;
    SharedCable* cable_ = nullptr;
    pthread_t thread_{};
    bool started_ = false;
    std::atomic<bool> ended_{false};
};

} // namespace dicot::gadget_parts
