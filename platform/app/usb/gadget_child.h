// The process that shows the store to computers, beside `dicot run`: its end never is the series' matter.
#pragma once

#include "dicot/base/status.h"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

namespace dicot::app {

/// Starts this program again as `dicot gadget up`, and again when it fails: after a minute, then after longer and
/// longer pauses, an hour at most. One that somebody has ended ('dicot gadget down') stays so. Takes from the heap in
/// start() alone, which comes before the seal.
class GadgetChild
{
public:
    GadgetChild() = default;
    GadgetChild(const GadgetChild&) = delete;
    GadgetChild& operator=(const GadgetChild&) = delete;
    ~GadgetChild(); ///< ends it, within kMostEndS; leaves one that not even SIGKILL ends, 5 s later

    static constexpr int kMostEndS = 20;
    static constexpr const char* kParent = "DICOT_GADGET_PARENT"; ///< in its environment: our number

    /// `program`: /proc/self/exe, but in tests. Fault::kOsError: no thread.
    Status start(std::vector<std::string> words, const char* program = "/proc/self/exe");

private:
    void look_after(const char* program);
    /// Its exit status as waitid(2) has it; negative: it was never there.
    int run_once(const char* program);

    std::vector<std::string> words_, environment_;
    std::vector<char*> word_pointers_, environment_pointers_;
    std::mutex lock_;
    std::condition_variable changed_;
    bool stop_ = false, ended_ = false, abandoned_ = false;
    pid_t child_ = 0;
    std::thread thread_;
};

/// In the child: it ends with `dicot run`, gives way to it, and is the first to go when memory runs out. Nothing
/// elsewhere.
void live_with_parent() noexcept;
/// That it ends with `dicot run` alone: again after this process became another user, which the kernel takes as its
/// end.
void end_with_parent() noexcept;

} // namespace dicot::app
