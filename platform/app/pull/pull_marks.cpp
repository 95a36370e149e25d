#include "pull_marks.h"

#include "../stop_request.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace dicot::app {

void PullMarks::add(const PullSource::Pulled& pulled)
{
    waiting_.push_back(pulled);
    if (waiting_.size() >= kBatch)
        tell(false);
}

void PullMarks::tell(bool patient)
{
    std::vector<PullSource::Pulled> batch;
    batch.swap(waiting_);
    for (std::size_t at = 0; at < batch.size() && takes_marks_; at += kBatch)
        tell(std::span(batch).subspan(at, std::min(kBatch, batch.size() - at)), patient);
}

Status PullMarks::mark_patiently(std::span<const PullSource::Pulled> batch, bool patient)
{
    using namespace std::chrono_literals;
    constexpr int kLooks = 10;
    for (;;) {
        const std::int64_t begin_us = monotonic_us();
        Status marked = source_.mark(batch);
        if (marked.fault() != Fault::kTryAgain || !patient)
            return marked;
        for (int k = 0; k < kLooks && !StopRequest::asked(); ++k)
            std::this_thread::sleep_for(100ms);
        patience_us_ -= monotonic_us() - begin_us;
        if (patience_us_ <= 0 || StopRequest::asked())
            return marked;
    }
}

void PullMarks::tell(std::span<const PullSource::Pulled> batch, bool patient)
{
    const Status marked = mark_patiently(batch, patient);
    const auto count = static_cast<std::int64_t>(batch.size());
    switch (marked.fault()) {
    case Fault::kOk:
        report_.marked += count;
        return;
    case Fault::kUsage:
        takes_marks_ = false;
        if (StopRequest::asked()) // that is no rule of the board's
            report_.unmarked += count;
        else
            report_.marks_why = marked.message();
        return;
    case Fault::kTryAgain:
        if (!patient)
            waiting_.insert(waiting_.end(), batch.begin(), batch.end());
        else
            report_.unmarked += count;
        return;
    case Fault::kNoInput:
    case Fault::kBadData:
        // None of the batch is marked because of one of them: the halves part it from the others.
        if (count > 1) {
            tell(batch.first(batch.size() / 2), patient);
            if (takes_marks_)
                tell(batch.subspan(batch.size() / 2), patient);
        } else if (marked.fault() == Fault::kBadData)
            ++report_.mark_refused;
        return;
    default:
        report_.unmarked += count;
        return;
    }
}

} // namespace dicot::app
